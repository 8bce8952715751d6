#include "hw_bridge/watched_adc.h"

#include <gmock/gmock.h>

#include <atomic>
#include <cmath>
#include <thread>

#include "twin/core/device_fault.h"
#include "twin/core/units.h"

namespace twinbench::hw {
namespace {

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

FaultKind HowABlockEnds(CreepingTable& target) {
  CreepingTable reference(1000, 0.0);
  LongBlock adc(target, 3);  // the look that finds it off is the last
  WatchedAdc watched(adc, {"target", target, kTolerance_rad}, {"reference", reference, kTolerance_rad});
  try {
    watched.Acquire(100, false);
  } catch (const DeviceFault& fault) {
    return fault.kind();
  }
  return FaultKind::kStopped;  // none
}

TEST(WatchedAdc, SeesATableThatLeavesItsStopInTheMiddleOfABlock) {
  CreepingTable creeping(3, 0.06 * units::arcsec);
  EXPECT_EQ(HowABlockEnds(creeping), FaultKind::kMoved);
  EXPECT_GE(creeping.looks, 3);
}

TEST(WatchedAdc, SeesAControllerThatRestartsInTheMiddleOfABlock) {
  CreepingTable restarted(3, kNaN);
  EXPECT_EQ(HowABlockEnds(restarted), FaultKind::kRestarted);
}

TEST(WatchedAdc, TellsWhatALookFailedOf) {
  CreepingTable silent(1, 0.0);
  silent.fails = true;
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
