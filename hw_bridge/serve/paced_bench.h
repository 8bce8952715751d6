#pragma once

#include "hw_bridge/serve/paced_clock.h"
#include "hw_bridge/serve/scan_stream.h"

namespace twinbench::hw {

/// The paced clock of a rotary bench, whose converter runs on by itself as long as somebody reads it.
class PacedBench : public PacedClock {
 public:
  PacedBench(RotaryBench bench, const AdcSettings& adc, double speed, Wall wall = WallClock::now);

  RotaryBench& bench() { return bench_; }
  ScanStream& stream() { return stream_; }

  using PacedClock::LetGetOn, PacedClock::Settle;
  Poll Settle(RotaryTable& table, Duration within) { return Settle(SettlingOf(table), within); }
  void LetGetOn(RotaryTable& table) { LetGetOn(SettlingOf(table)); }

  void AddReader() { ++readers_; }
  void RemoveReader() { --readers_; }

 private:
  static Settles SettlingOf(RotaryTable& table) {
    return [&table](Duration within) { return table.Settles(within); };
  }
  void Follow(Duration behind) override;
  void ForgetAhead() override { stream_.Forget(); }

  RotaryBench bench_;
  ScanStream stream_;
  int readers_ = 0;
};

}  // namespace twinbench::hw
