#include <gtest/gtest.h>

#include <map>
#include <sstream>

#include "tests/machine/benches.h"
#include "tests/machine/driven_twin.h"
#include "tests/support/troubled_machine.h"
#include "twin/core/bench_format.h"

/// Somebody else - a pendant, another program - stops or moves the machine in the middle of a run. The twin does not say that it is
/// one, so that what is kept is what was taken.
namespace twinbench::test {
namespace {

constexpr double kFarAway = 1e-3;  // m or rad: what a hand moves
constexpr double kAtItsStop = 1e-6;

enum class Hand { kStops, kJogs };

void Act(Hand hand, MachineController& machine) {
  if (hand == Hand::kStops) return machine.Stop();
  std::vector<double> to;
  for (const AxisState& state : machine.State()) to.push_back(state.encoder);
  to.back() += kFarAway;
  machine.StartMove(to, 0.0);
}

MachineBench AsHardware(const MachineBench& twin) {
  return {twin.clock, twin.machine, twin.instruments, twin.fixture, nullptr, twin.indexer};
}

/// A run in which a hand acts before the machine is asked for the n-th time; never: 0.
struct HandledRun {
  HandledRun(const Scenario& scenario, Hand hand, int at_call)
      : twin(scenario),
        troubled(Unsimulated(), InstrumentColumns(FormatOf(scenario.bench).columns),
                 [=, this](const std::string& device, const std::string& request, std::string&) {
                   if (device == "machine" && request != "stop" && ++calls == at_call) Act(hand, twin.bench.machine);
                 }) {
    MachineBench bench = troubled.Bench();
    fault = twin.FaultOn(bench);
  }
  MachineBench Unsimulated() const { return AsHardware(twin.bench); }

  DrivenTwin twin;
  TroubledMachine troubled;
  int calls = 0;
  std::string fault;
};

/// Where axes stood about readings at rest, as files have it.
std::map<std::string, double> Places(const Reading& reading) {
  std::map<std::string, double> places;
  for (const auto& [column, text] : reading.extra) places[column] = std::stod(text);
  return places;
}

class SomebodyElse : public testing::TestWithParam<Scenario (*)()> {};

TEST_P(SomebodyElse, WhoStopsOrMovesAnAxisCostsAnAttemptAndLeavesNoReadingAtAWrongPlace) {
  constexpr int kMoments = 12;
  const HandledRun undisturbed(GetParam()(), Hand::kStops, 0);
  ASSERT_EQ(undisturbed.fault, "") << undisturbed.twin.said;
  const std::vector<Reading>& expected = undisturbed.twin.log.readings;
  for (const Hand hand : {Hand::kStops, Hand::kJogs}) {
    int noticed = 0;
    for (int moment = 1; moment <= kMoments; ++moment) {
      const int at_call = undisturbed.calls * moment / (kMoments + 1) + moment % 5;  // before, in and behind moves, and about readings
      const HandledRun run(GetParam()(), hand, at_call);
      noticed += !run.twin.log.attempts.empty();
      const std::vector<Reading>& kept = run.twin.log.readings;
      if (run.fault.empty()) {
        EXPECT_EQ(kept.size(), expected.size());
      }
      for (std::size_t k = 0; k < kept.size(); ++k) {
        const auto places = Places(kept[k]), meant = Places(expected[k]);
        ASSERT_EQ(places.size(), meant.size()) << k;
        for (const auto& [column, place] : meant)
          EXPECT_NEAR(places.at(column), place, kAtItsStop / units::mm) << column << " of reading " << k << ", call " << at_call;
      }
    }
    if (hand == Hand::kJogs) {
      EXPECT_GE(noticed, kMoments / 2);  // a jog before a move that goes elsewhere anyway changes nothing
    }
  }
}

/// The call that begins a circle, with its feed times `factor`; others as they are.
std::string Overridden(const std::string& request, double factor) {
  if (!request.starts_with("arc ")) return request;
  constexpr int kFeed = 6;
  std::istringstream words(request);
  std::string changed, word;
  for (int k = 0; words >> word; ++k) changed += (k > 0 ? " " : "") + (k == kFeed ? std::to_string(factor * std::stod(word)) : word);
  return changed;
}

TEST(SomebodyElse, WhoTurnsTheFeedOverrideEndsACircle) {
  for (const auto& [factor, fault] : {std::pair(1.0, ""), {0.5, "following"}, {1.5, "following"}}) {
    DrivenTwin twin(ShortCircles());
    MachineBench inner = AsHardware(twin.bench);
    const std::vector<ReadingColumn> shown = InstrumentColumns(FormatOf(twin.scenario.bench).columns);
    AskedMachine overridden(
        [&](const std::string& device, const std::string& request) { return Perform(inner, shown, device, Overridden(request, factor)); },
        [&] { return inner.clock.Now(); }, {inner.machine.Axes(), shown, false, nullptr});
    MachineBench bench = overridden.Bench();
    EXPECT_EQ(twin.FaultOn(bench), fault) << factor << twin.said;
  }
}

INSTANTIATE_TEST_SUITE_P(Benches, SomebodyElse, testing::Values(ShortCircles, ShortFreeform, ShortTurntable, ShortStops));

}  // namespace
}  // namespace twinbench::test
