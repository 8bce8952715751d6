#include "hw_bridge/open_bench.h"

#include <gmock/gmock.h>

#include "hw_bridge/ad/ad_source.h"
#include "tests/hw_control/fake_controller.h"
#include "tests/hw_control/faults.h"
#include "tests/support/rotary_scenario.h"
#include "tests/support/served_twin.h"

namespace twinbench::hw {
namespace {

using test::KindOf, test::ServedTwin;
using testing::HasSubstr;

BenchFile FileOf(const ServedTwin& served, const std::string& tables) {
  return ParseBenchFile(WriteServedBenchFile(served.at(), tables), "served.toml", "/");
}

Scenario Noisy() {
  Scenario scenario = test::RotaryScenario();
  scenario.environment.drift_K_h = 1.0;
  return scenario;
}

class OpenedBench : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    if (!HasAdDriver("iio")) GTEST_SKIP() << "this build has no libiio";
  }
};
INSTANTIATE_TEST_SUITE_P(Tables, OpenedBench, testing::Values("scpi", "esp", "pty"),
                         [](const auto& tables) { return std::string(tables.param); });

TEST_P(OpenedBench, HearsAStopWithinATenthOfASecondWhileATableMoves) {
  const Scenario scenario = Noisy();
  ServedTwin served(scenario);
  const RotarySettings& own = RotaryOf(scenario);
  bool is_asked = false;
  const auto opened = OpenHardware(FileOf(served, GetParam()), own.adc, own.amplifier.noise_V, {}, 0, [&] { return is_asked; });
  const RotaryBench bench = opened->Bench();
  bench.target.StartMove(1.5);  // takes seconds
  EXPECT_FALSE(bench.target.Settles(std::chrono::milliseconds(300)));
  const Time asked = bench.clock.Now();
  is_asked = true;
  EXPECT_EQ(KindOf([&] { bench.target.Settles(std::chrono::seconds(1)); }), FaultKind::kStopped);
  EXPECT_LE(bench.clock.Now() - asked, std::chrono::milliseconds(100));
  EXPECT_TRUE(bench.target.State().moving) << "stopping is for whoever caught it";
}

TEST_P(OpenedBench, SaysWhoAnsweredTheSameAtEveryOpening) {
  ServedTwin served(Noisy());
  const BenchFile file = FileOf(served, GetParam());
  std::string identity = test::OpenHardware(file, Noisy())->Identity();
  EXPECT_THAT(identity, HasSubstr("served twin: "));
  EXPECT_THAT(identity, HasSubstr("twinbench,rotary-bench,"));
  EXPECT_EQ(test::OpenHardware(file, Noisy())->Identity(), identity);
}

TEST_P(OpenedBench, RefusesAnotherDeviceThanTheFileNamesAndSoftLimitsThatTheControllerDoesNotAllow) {
  ServedTwin served(Noisy());
  BenchFile another = FileOf(served, GetParam()), wider = another;
  another.target.identity = another.reference.identity = "somebody else";
  another.target.timeout_s = 0.3;  // on a serial line it might still answer
  if (std::string(GetParam()) == "scpi") another.thermometer.identity = "somebody else";
  EXPECT_EQ(KindOf([&] { test::OpenHardware(another, Noisy()); }), FaultKind::kIdentity);
  wider.target_limits.upper_rad = 1.1e4;  // the served one stops at 1e4
  EXPECT_EQ(KindOf([&] { test::OpenHardware(wider, Noisy()); }), FaultKind::kRefused);
}

TEST(OpenBench, WithNobodyThereIsAFaultThatNamesTheDevice) {
  const test::ReservedPort port;
  BenchFile file;
  file.target = file.reference = {"scpi", port.Address()};
  file.target.timeout_s = 0.1;
  const auto open = [&] { test::OpenHardware(file, Noisy()); };
  EXPECT_EQ(KindOf(open), FaultKind::kDropped);
  EXPECT_THAT(test::TextOf(open), HasSubstr("target: cannot be reached"));
}

}  // namespace
}  // namespace twinbench::hw
