#pragma once

#include <cstdint>

#include "twin/core/reading.h"
#include "twin/core/time.h"

namespace twinbench::hw {

/// Holds a card's clock against the bench's from block to block. Two clocks of different make part slowly; a jump
/// means that one of them cannot be trusted. A twin that is started again takes both back, which is none.
class ClockWatch {
 public:
  /// @param card_ns  The card's time of a block's first scan.
  /// @param bench    Bench time when the block was asked for; the scan came at most `latency` later.
  /// @throws DeviceFault kClock if the times passed since the block before differ by more than 100 ppm, both
  /// latencies and 1 ms. The next block is held against this one all the same: stamps that stand still, or those of blocks that
  /// are handed over again, do not pass at every second attempt.
  void Compare(std::int64_t card_ns, Time bench, Duration latency);
  void Forget() { known_ = false; }

  /// How much faster the card's clock has gone than the bench's since both were last started, and the standard
  /// uncertainty that the latencies leave (rectangular); NaN before a second block.
  struct Drift {
    double ppm = kNaN, u_ppm = kNaN;
  };
  Drift DriftSoFar() const;

 private:
  struct Meeting {
    std::int64_t card_ns = 0;
    Time bench{};
    Duration latency{};
  };
  bool known_ = false;
  Meeting first_;
  Meeting last_;  // of the block before
};

}  // namespace twinbench::hw
