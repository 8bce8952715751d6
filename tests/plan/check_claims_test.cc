#include "tests/perf/timing.h"
#include "tests/support/night.h"
#include "tools/twinbench/passing_run.h"
#include "tools/twinbench/plan_advice.h"
#include "twin/benches/evaluated.h"

/// `check` says of a scenario in a second what its run would state (docs/plan.md): held against the runs of the shipped scenarios.
namespace twinbench::tools {
namespace {

/// Scenario and result that are further off.
const std::set<std::string> kKnown = {"circular_bodies errors.bar.ball3_um"};  // its bodies move as no kinematic machine does

std::vector<std::string> ShippedScenarios() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(TWINBENCH_SOURCE_DIR "/scenarios"))
    if (entry.path().extension() == ".toml") names.push_back(entry.path().stem().string());
  std::ranges::sort(names);
  return names;
}

Scenario Shipped(const std::string& name, const std::vector<std::string>& sets = {}) {
  return LoadScenario(TWINBENCH_SOURCE_DIR "/scenarios/" + name + ".toml", sets);
}

/// Of a processor that others use: the least of three goes, if the first takes long.
double LeastCpuSeconds(const std::function<void()>& go) {
  double least_s = kNaN;
  for (int again = 0; again < 3 && !(least_s < 1.0); ++again) {
    const double begin_s = perf::Seconds();
    go();
    least_s = std::fmin(least_s, perf::Seconds() - begin_s);
  }
  return least_s;
}

TEST(Check, TakesLessThanASecond) {
  const std::vector<std::string> longest = {"circular_motion", "encoder_coast", "hob_drive_orders"};  // of all, which are timed by night
  for (const std::string& name : test::IsNight() ? ShippedScenarios() : longest)
    EXPECT_LT(LeastCpuSeconds([&name] { OutlookAtOnce(Shipped(name)); }), 1.0) << name;
  const Scenario slow_train = Shipped("hob_transmission", {"hob_procedure.turns=1", "hob_procedure.hob_speeds_rev_min=[0.5]"});
  EXPECT_LT(LeastCpuSeconds([&slow_train] { ReadingsOfTwin(Quick(slow_train)); }), 1.0);
}

/// Phases and azimuths go with amplitudes that may be mere noise: their u is no promise.
bool IsPromised(const std::string& scenario, const plan::Certainty& stated) {
  const bool is_known = std::ranges::any_of(kKnown, [&](const std::string& known) { return (scenario + " " + stated.name).starts_with(known); });
  const bool is_phase = stated.name.find("phase") != stated.name.npos || stated.name.find("azimuth") != stated.name.npos;
  return !is_known && !is_phase && std::isfinite(stated.rms_u) && stated.rms_u > 0.0;
}

void ExpectWhatTheRunStates(const std::string& name, const Scenario& scenario) {
  SCOPED_TRACE(name);
  const std::vector<Reading> readings = ReadingsOfTwin(scenario);
  const plan::Outlook stated = plan::OutlookOf(EvaluationOf(scenario, readings, Estimator::kRigorous).results, static_cast<int>(readings.size()), 0.0);
  const plan::Outlook said = OutlookAtOnce(scenario);
  for (const plan::Certainty& result : stated.results) {
    if (!IsPromised(name, result)) continue;
    const auto before = std::ranges::find(said.results, result.name, &plan::Certainty::name);
    ASSERT_NE(before, said.results.end()) << result.name;
    // Where an evaluation finds the noise in its readings, two runs differ by 3 to 10 %: 20 % are two of that and more.
    EXPECT_NEAR(before->rms_u / result.rms_u, 1.0, 0.2) << result.name;
  }
}

TEST(Check, SaysTheUncertaintiesThatTheRunStates) {
  if (test::IsNight()) {
    for (const std::string& name : ShippedScenarios()) ExpectWhatTheRunStates(name, Shipped(name));
    return;
  }
  for (const char* name : {"encoder_comparison", "turntable_shifts"}) ExpectWhatTheRunStates(name, Shipped(name));
  ExpectWhatTheRunStates("hob_drive_orders", Shipped("hob_drive_orders", {"mechanics.fidelity=kinematic", "hob_procedure.samples_per_turn=240"}));
}

/// What a plan says of the scenario's run is what `check` says of it; the mean over other seeds stands beside it.
TEST(Check, SaysOfTheScenariosRunWhatAPlanSays) {
  const Scenario scenario = Shipped("turntable_shifts");
  const plan::Outlook checked = OutlookAtOnce(scenario);
  Patience without_end;
  const report::PlannedRun planned = OwnRun(scenario, ResultsOfOwn(scenario).planned.outlook, without_end);
  ASSERT_EQ(planned.outlook.results.size(), checked.results.size());
  for (std::size_t k = 0; k < checked.results.size(); ++k) EXPECT_EQ(planned.outlook.results[k].rms_u, checked.results[k].rms_u) << checked.results[k].name;
  EXPECT_GE(planned.mean_of, 4u);
}

}  // namespace
}  // namespace twinbench::tools
