#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

#include "tests/uncertainty/bench_budget.h"
#include "twin/benches/registry.h"
#include "twin/plan/next_run.h"

namespace twinbench::plan {
namespace {

/// One of the runs that a bench offers next, made on the twin beside the scenario's own.
struct Beside {
  std::vector<Reading> own, next;
  Scenario scenario, of_next;
};

Beside RunsOf(const std::string& file, std::vector<std::string> sets, const std::string& name) {
  Beside runs;
  runs.scenario = LoadScenario(test::ScenarioPath(file), sets);
  const std::vector<NextRun> offered = BenchOf(runs.scenario).next_runs(runs.scenario);
  const auto run = std::ranges::find(offered, name, &NextRun::name);
  if (run == offered.end()) throw std::runtime_error("no run " + name);
  sets.insert(sets.end(), run->sets.begin(), run->sets.end());
  runs.of_next = LoadScenario(test::ScenarioPath(file), sets);
  runs.own = test::ReadingsOf(runs.scenario);
  runs.next = test::ReadingsOf(runs.of_next);
  return runs;
}

double MeanVariance(const Scenario& scenario, const std::vector<Reading>& readings, const std::string& kind) {
  double sum = 0.0;
  int count = 0;
  for (const uncertainty::Quantity& q : test::QuantitiesFrom(scenario, readings)) {
    if (uncertainty::KindOf(q.name) != kind) continue;
    sum += q.u * q.u;
    ++count;
  }
  return sum / count;
}

/// Half of the uncertainty in the time of one run, where a second run would leave 0.7 of it.
TEST(NextRuns, OfASweepReadItAsOftenAsAReadingTakes) {
  const Beside runs = RunsOf("encoder_comparison.toml", {"encoder_procedure.kind=sweep"}, "denser");
  EXPECT_EQ(runs.next.size(), 4 * runs.own.size()) << "every 0.02 s, not every 0.08 s";
  EXPECT_NEAR(ToSeconds(runs.next.back().time), ToSeconds(runs.own.back().time), 0.1);
  const std::string kind = "device.ez_arcsec";
  EXPECT_NEAR(MeanVariance(runs.of_next, runs.next, kind) / MeanVariance(runs.scenario, runs.own, kind), 0.25,
              0.03);
}

/// 18000 lines, of which every third may be kept where the computer looks each 2 s, every fifteenth where it does
/// each 10 s.
TEST(NextRuns, OfATransmissionLeaveTheCounterTimeToBeEmptied) {
  for (const auto& [poll, times] : {std::pair{"2.0", 6000.0 / 720.0}, std::pair{"10.0", 1200.0 / 720.0}}) {
    const Beside runs = RunsOf(
        "hob_transmission.toml",
        {"mechanics.fidelity=kinematic", "hob_procedure.turns=1", std::string("hob_procedure.poll_s=") + poll},
        "denser");
    const double count = static_cast<double>(runs.next.size());
    EXPECT_NEAR(count / static_cast<double>(runs.own.size()), times, 0.03 * times) << poll;
    EXPECT_TRUE(std::ranges::all_of(runs.next, [](const Reading& r) { return r.status == ReadingStatus::kOk; }));
  }
}

}  // namespace
}  // namespace twinbench::plan
