#pragma once

#include <functional>
#include <set>

#include "hw_bridge/serve/conversation.h"
#include "hw_bridge/serve/scan_stream.h"
#include "twin/core/devices.h"

namespace twinbench::hw {

/// Bench time against the wall clock.
///
/// Running: bench time follows the wall clock times `speed`. Held by a client: it passes only in calls that take
/// time, and the wall clock follows: replies are late. Either way `due_` is the wall time at which the bench's
/// present counts as reached. Timeless (speed infinity, or a client said that held time shall cost nothing): nobody
/// waits.
class PacedBench {
 public:
  /// @param speed  Bench seconds a wall second; infinity: as fast as it goes.
  PacedBench(RotaryBench bench, const AdcSettings& adc, double speed);

  RotaryBench& bench() { return bench_; }
  ScanStream& stream() { return stream_; }

  /// Running: brings the bench to where the wall clock is. Called before every look at the bench.
  void CatchUp();
  bool Held() const { return !holders_.empty(); }
  bool Timeless() const;
  /// A call that takes bench time takes it at once; otherwise its end has to be waited for.
  bool Immediate() const { return Held() || Timeless(); }

  /// `who` is any address that identifies a client.
  void Hold(const void* who, bool hold);
  void SetPaced(const void* who, bool paced);
  void Leave(const void* who);
  void Restart();

  /// Runs `call` on the bench; the bench time it takes is booked against the wall clock.
  void Spend(const std::function<void()>& call);
  /// How long the wall clock needs to reach the bench's present.
  WallClock::duration Lag() const;

  /// "1" when `table` has settled, "0" after `within` of bench time.
  Poll Settle(RotaryTable& table, Duration within);
  /// "" when so much bench time has passed.
  Poll Pass(Duration duration);
  /// A client that watches a moving table where time does not pass by itself sees it get on, up to this long.
  void LetGetOn(RotaryTable& table);

  /// The converter runs on by itself as long as somebody reads it.
  void AddReader() { ++readers_; }
  void RemoveReader() { --readers_; }

 private:
  void Follow(Duration behind);
  void TakeScans(Duration behind);
  WallClock::duration OnWall(Duration bench_time) const;

  RotaryBench bench_;
  double speed_;
  ScanStream stream_;
  WallClock::time_point due_ = WallClock::now();
  std::set<const void*> holders_, unpaced_;
  int readers_ = 0;
};

}  // namespace twinbench::hw
