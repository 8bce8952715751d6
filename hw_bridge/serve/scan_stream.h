#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "twin/core/devices.h"
#include "twin/core/scenario.h"

namespace twinbench::hw {

/// Scans with a time stamp each, as a client gets them.
struct ScanBlock {
  std::vector<std::int16_t> raw;        // scans x channels, two's complement
  std::vector<std::int64_t> stamps_ns;  // bench time of each scan
  std::size_t scans() const { return stamps_ns.size(); }
};

/// "ok", "no_light", "clipped_spot": what the status lines of the PSD amplifiers say.
const char* LightOf(ReadingStatus status);

/// The converter of the bench, running on by itself: whoever reads it slowly misses scans.
///
/// It holds the last second at most, in blocks of a fixed number of scans, numbered since it was made.
class ScanStream {
 public:
  /// @param block_scans  Taken at a time.
  ScanStream(AdConverter& adc, Clock& clock, const AdcSettings& settings, int block_scans);

  /// One block of its own, whatever ran before: `scans` scans from now on. A FIFO that runs full on the way leaves
  /// a step in the time stamps.
  ScanBlock TakeOne(int scans);

  /// Takes the next block of the running converter.
  void TakeNext();
  /// Lets bench time pass without taking scans: nobody could keep up.
  void Miss(Duration duration);
  void Forget() { held_.clear(); }

  Duration BlockTime() const { return TimeOf(block_scans_); }
  Duration HeldAtMost() const { return TimeOf(kept_scans_); }
  Duration TimeOf(std::int64_t scans) const;
  std::int64_t next_scan() const { return next_scan_; }

  /// Appends scans from number `cursor` on to `block` until it has `scans`, and moves `cursor`. Scans that are gone
  /// are skipped and counted as overruns.
  void Read(std::int64_t& cursor, std::size_t scans, ScanBlock& block);

  const std::string& light() const { return light_; }
  void SetLight(const std::string& light) { light_ = light; }
  std::int64_t overruns() const { return overruns_; }

 private:
  struct Held {
    std::int64_t first_scan;
    ScanBlock block;
  };
  ScanBlock Stamped(Acquisition taken, int scans);

  AdConverter& adc_;
  Clock& clock_;
  double rate_Hz_;  // conversions
  int block_scans_;
  std::int64_t kept_scans_;
  std::deque<Held> held_;
  std::int64_t next_scan_ = 0, overruns_ = 0;
  std::string light_ = "ok";
};

}  // namespace twinbench::hw
