#include "hw_bridge/ad/ad_source.h"
#include "hw_bridge/control/scpi.h"
#include "hw_bridge/control/served_clock.h"
#include "hw_bridge/watched_adc.h"
#include "tests/hw_control/fake_controller.h"
#include "tests/support/faults.h"
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

constexpr Duration kAmpleTime = std::chrono::seconds(5);

/// How much bench time passes by itself in 20 ms.
Duration Drift(const ScpiClock& clock) {
  const Time before = clock.Now();
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  return clock.Now() - before;
}

/// The clock of a served twin in real time.
struct ClockInRealTime {
  ServedTwin served{test::RotaryScenario(), 1.0};
  Dialogue talk{ParseAddress(served.ScpiAddress()).value(), kScpiIdentity, "twinbench,"};
  ScpiClock clock{{talk, "clock", kAmpleTime}};
};

TEST(ServedClock, IsHeldAgainWhereItsConnectionHadToBeOpenedAgain) {
  ClockInRealTime real;
  EXPECT_EQ(Drift(real.clock), Duration(0));
  real.talk.Close();
  EXPECT_EQ(Drift(real.clock), Duration(0));
}

TEST(ServedClock, WaitsWhatItIsToldAndTakesNoRealTimeUnpaced) {
  ClockInRealTime real;
  ScpiClock& clock = real.clock;
  ScpiSimulation(clock).SetPaced(false);
  const Time before = clock.Now();
  clock.Wait(std::chrono::hours(10));  // far beyond what this test may take
  EXPECT_EQ(clock.Now() - before, std::chrono::hours(10));
  ScpiSimulation(clock).SetPaced(true);
  const auto begin = std::chrono::steady_clock::now();
  clock.Wait(std::chrono::milliseconds(50));
  EXPECT_GE(std::chrono::steady_clock::now() - begin, std::chrono::milliseconds(50));
}

/// A table that stands off its stop from some look on; nobody knows how far (NaN): it has lost its origin.
class CreepingTable : public RotaryTable {
 public:
  CreepingTable(int from_look, double off_rad) : from_look_(from_look), off_rad_(off_rad) {}
  TableState State() override {
    if (fails) throw DeviceFault(FaultKind::kTimeout, "target", "no answer");
    TableState state;
    state.commanded_rad = 1.0;
    state.encoder_rad = 1.0 + (++looks >= from_look_ ? off_rad_ : 0.0);
    state.referenced = !std::isnan(state.encoder_rad);
    return state;
  }
  void StartMove(double) override {}
  bool Settles(Duration) override { return true; }
  void Stop() override {}
  void Home() override {}

  std::atomic<int> looks = 0;
  bool fails = false;

 private:
  int from_look_;
  double off_rad_;
};

/// A block that lasts until a table has been looked at so often, or a look has failed.
class LongBlock : public AdConverter {
 public:
  LongBlock(const CreepingTable& table, int looks) : table_(table), looks_(looks) {}
  Acquisition Acquire(int n_samples, bool) override {
    while (table_.looks < looks_ && !table_.fails) std::this_thread::yield();
    Acquisition block;
    block.n_samples = n_samples;
    return block;
  }

 private:
  const CreepingTable& table_;
  int looks_;
};

constexpr double kTolerance_rad = 0.05 * units::arcsec;

std::optional<FaultKind> HowABlockEnds(CreepingTable& target) {
  CreepingTable reference(1000, 0.0);
  LongBlock adc(target, 3);  // the look that finds it off is the last
  WatchedAdc watched(adc, {"target", target, kTolerance_rad}, {"reference", reference, kTolerance_rad});
  return KindOf([&] { watched.Acquire(100, false); });
}

TEST(WatchedAdc, SeesATableThatLeavesItsStopOrRestartsInTheMiddleOfABlockAndTellsWhatALookFailedOf) {
  CreepingTable creeping(3, 0.06 * units::arcsec), restarted(3, kNaN), silent(1, 0.0);
  silent.fails = true;
  EXPECT_EQ(HowABlockEnds(creeping), FaultKind::kMoved);
  EXPECT_GE(creeping.looks, 3);
  EXPECT_EQ(HowABlockEnds(restarted), FaultKind::kRestarted);
  EXPECT_EQ(HowABlockEnds(silent), FaultKind::kTimeout);
}

TEST(WatchedAdc, HandsABlockOverAndRemembersHowFarTheTablesWereOff) {
  CreepingTable target(3, -0.04 * units::arcsec), reference(2, 0.01 * units::arcsec);
  LongBlock adc(target, 4);
  WatchedAdc watched(adc, {"target", target, kTolerance_rad}, {"reference", reference, kTolerance_rad});
  EXPECT_EQ(watched.Acquire(100, false).n_samples, 100);
  EXPECT_NEAR(watched.tables()[0].furthest_rad / units::arcsec, -0.04, 1e-7);
  EXPECT_NEAR(watched.tables()[1].furthest_rad / units::arcsec, 0.01, 1e-7);
}

}  // namespace
}  // namespace twinbench::hw
