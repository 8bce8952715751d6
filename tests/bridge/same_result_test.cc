#include <gtest/gtest.h>

#include "tests/bridge/served_run.h"

/// Same scenario, same seed, same result, whatever the bench is reached by.
namespace twinbench::test {
namespace {

class SameResult : public ::testing::TestWithParam<const char*> {};

TEST_P(SameResult, ThroughTheRealBackendsAsInThisProgram) {
  for (const char* fidelity : {"kinematic", "linear"}) {
    Scenario scenario = RestlessBench();
    scenario.mechanics.fidelity = fidelity;
    const ServedTwin served(scenario);
    RunOptions options;
    options.tables = GetParam();
    const ServedRun run = RunServed(served, scenario, options);
    EXPECT_EQ(run.stopped_by, "") << run.said;
    EXPECT_EQ(run.Readings(), InProcess(scenario)) << fidelity;
    EXPECT_TRUE(run.log.attempts.empty());
  }
}

TEST_P(SameResult, ASecondTimeOnTheSameServer) {
  const Scenario scenario = RestlessBench();
  const ServedTwin served(scenario);
  RunOptions options;
  options.tables = GetParam();
  const std::string first = RunServed(served, scenario, options).Readings();
  EXPECT_EQ(RunServed(served, scenario, options).Readings(), first);
}

INSTANTIATE_TEST_SUITE_P(Tables, SameResult, ::testing::Values("scpi", "esp", "pty"),
                         [](const auto& instance) { return std::string(instance.param); });

TEST(SameResult, InRealTimeAsWithoutAnyTime) {
  // 25 readings, two minutes of bench time; at 200 times real time the pacing waits for every step.
  Scenario scenario = RestlessBench();
  scenario.procedure.phases = {"full_circle"};
  const ServedTwin served(scenario, OnFreePorts(200.0));
  const ServedRun run = RunServed(served, scenario);
  EXPECT_EQ(run.stopped_by, "") << run.said;
  EXPECT_EQ(run.Readings(), InProcess(scenario));
}

TEST(SameResult, WithReadingsThatHaveNoNumbers) {
  Scenario scenario = RestlessBench();
  scenario.amplifier.offset_V[2] = 9.99;  // saturates at some stops
  const ServedTwin served(scenario);
  const std::string expected = InProcess(scenario);
  EXPECT_NE(expected.find("saturated"), std::string::npos);
  EXPECT_EQ(RunServed(served, scenario).Readings(), expected);

  scenario = RestlessBench();
  scenario.psd_a.width_m = 0.2e-3;  // the calibration sweep takes the spot off the PSD
  const ServedTwin clipped(scenario);
  const std::string dark = InProcess(scenario);
  EXPECT_NE(dark.find("no_light"), std::string::npos);
  EXPECT_EQ(RunServed(clipped, scenario).Readings(), dark);
}

}  // namespace
}  // namespace twinbench::test
