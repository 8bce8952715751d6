#include "tests/support/served_run.h"

/// Same scenario, same seed, same result, whatever the bench is reached by.
namespace twinbench::test {
namespace {

struct Way {
  const char *converter, *tables;
  friend void PrintTo(const Way& way, std::ostream* out) { *out << way.converter << ' ' << way.tables; }
};

class SameResult : public ::testing::TestWithParam<Way> {
 protected:
  void SetUp() override {
    options_.converter = GetParam().converter;
    options_.tables = GetParam().tables;
    const bool comedi = options_.converter == "comedi";
    if (comedi && !MissingComedi().empty()) GTEST_SKIP() << MissingComedi();
  }
  RunOptions options_;
};

TEST_P(SameResult, ThroughTheRealBackendsAsInThisProgram) {
  for (const char* fidelity : {"kinematic", "linear", "bullet"}) {
    const Scenario scenario = Altered(RestlessBench(), {std::string("mechanics.fidelity=") + fidelity});
    const ServedTwin served(scenario);
    const ServedRun run = RunServed(served, scenario, options_);
    EXPECT_EQ(run.stopped_by, "") << run.said;
    EXPECT_EQ(run.Readings(), InProcess(scenario)) << fidelity;
    EXPECT_TRUE(run.log.attempts.empty());
  }
}

TEST_P(SameResult, WithServosThatSettleSlowly) {
  // 6 Hz ring on long behind the in-position window: when the tables are quiet is found by looking.
  const Scenario scenario = Altered(RestlessBench(), {"mechanics.fidelity=linear", "mechanics.servo_Hz=[6, 6]"});
  const ServedTwin served(scenario);
  EXPECT_EQ(RunServed(served, scenario, options_).Readings(), InProcess(scenario));
}

TEST_P(SameResult, AStopOnTheWayAndHoming) {
  const Scenario scenario = RestlessBench();
  const ServedTwin served(scenario);
  const auto opened = OpenHardware(BenchFileOf(served, options_), scenario);
  sim::Twin twin(scenario);
  RotaryBench through = opened->Bench(), here = twin.Bench();
  through.simulation->Restart();
  for (const char* request : {"move 2", "settles 100000000", "state", "stop", "settles 5000000000", "state", "home",
                              "move 0.1", "settles 60000000000", "state"}) {
    EXPECT_EQ(Perform(through, "target", request).text, Perform(here, "target", request).text) << request;
    EXPECT_EQ(through.clock.Now(), here.clock.Now()) << request;
  }
}

INSTANTIATE_TEST_SUITE_P(Backends, SameResult,
                         ::testing::Values(Way{"iio", "scpi"}, Way{"iio", "esp"}, Way{"iio", "pty"},
                                           Way{"comedi", "scpi"}),
                         [](const auto& way) { return std::string(way.param.converter) + "_" + way.param.tables; });

TEST(SameResult, AFullFifoOfTheCardCostsOneAttemptAndNoBit) {
  if (!MissingComedi().empty()) GTEST_SKIP() << MissingComedi();
  const Scenario scenario = RestlessBench();
  const ServedTwin served(scenario);
  RunOptions options;
  options.converter = "comedi";
  options.faults[9] = "adc,drop";  // of the card's source: its FIFO runs dry and the command ends with EPIPE
  const ServedRun run = RunServed(served, scenario, options);
  EXPECT_EQ(run.Readings(), InProcess(scenario)) << run.said;
  ASSERT_EQ(run.log.attempts.size(), 1u);
  EXPECT_EQ(run.log.attempts[0].fault, "overrun");
}

TEST(SameResult, WithReadingsThatHaveNoNumbers) {
  Scenario scenario = RestlessBench();
  RotaryOf(scenario).amplifier.offset_V[2] = 9.99;  // saturates at some stops
  const ServedTwin served(scenario);
  const std::string expected = InProcess(scenario);
  EXPECT_NE(expected.find("saturated"), std::string::npos);
  EXPECT_EQ(RunServed(served, scenario).Readings(), expected);

  scenario = RestlessBench();
  RotaryOf(scenario).psd_a.width_m = 0.2e-3;  // the calibration sweep takes the spot off the PSD
  const ServedTwin clipped(scenario);
  const std::string dark = InProcess(scenario);
  EXPECT_NE(dark.find("no_light"), std::string::npos);
  EXPECT_EQ(RunServed(clipped, scenario).Readings(), dark);
}

}  // namespace
}  // namespace twinbench::test
