#include "tests/own_scenario/own_scenario.h"

#include <fmt/ranges.h>

#include <iostream>

#include "tests/support/angle_benches.h"
#include "tests/support/night.h"

namespace twinbench::test {
namespace {

struct Alarms {
  int runs = 0;                     // every key or effect counts as one
  std::vector<std::string> raised;  // key = value: cause, for each
  std::string InWords() const {
    return fmt::format("{} of {} runs:\n{}", raised.size(), runs, fmt::join(raised, "\n"));
  }
};

int Seeds() {
  return ByNight(4, 1);
}

Alarms AlarmsOf(const std::vector<OwnRun>& runs) {
  Alarms alarms;
  for (OwnRun run : runs) {
    alarms.runs += run.stated * Seeds();
    for (int k = 0; k < Seeds(); ++k, ++run.scenario.seed) {
      const std::string raised = AlarmOf(run);
      if (raised.empty()) continue;
      alarms.raised.push_back(fmt::format("{} (seed {}): {}", run.what, run.scenario.seed, raised));
      std::cout << alarms.raised.back() << std::endl;
    }
  }
  return alarms;
}

class OwnScenario : public ::testing::TestWithParam<OwnBench> {};

TEST_P(OwnScenario, NoKeyIsForgotten) {
  EXPECT_THAT(Forgotten(GetParam().name, GetParam().keys), testing::IsEmpty());
}

TEST_P(OwnScenario, RaisesNoAlarm) {
  const Alarms alarms = AlarmsOf(KeyRuns(GetParam(), IsNight() ? 1 : 10));
  EXPECT_LE(std::ssize(alarms.raised), alarms.runs / 50) << alarms.InWords();
}

TEST_P(OwnScenario, KnowsItsEffects) {
  const Alarms alarms = AlarmsOf(EffectRuns(GetParam(), IsNight() ? 1 : 4));
  EXPECT_LE(std::ssize(alarms.raised), alarms.runs / GetParam().effects_an_alarm) << alarms.InWords();
}

TEST_P(OwnScenario, IsDiagnosedWithoutAClock) {
  const OwnBench& bench = GetParam();
  const Scenario scenario = LoadScenario(ScenarioPath(bench.scenario), bench.base);
  std::vector<Reading> readings = ReadingsOf(scenario);
  for (Reading& r : readings) r.time = {};
  EXPECT_EQ(AlarmIn(readings, scenario), "");
}

INSTANTIATE_TEST_SUITE_P(EveryBench, OwnScenario, ::testing::ValuesIn(OwnBenches()),
                         [](const auto& of) { return of.param.name; });

}  // namespace
}  // namespace twinbench::test
