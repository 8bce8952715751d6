#pragma once

#include <array>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <stop_token>
#include <string>

#include "twin/core/devices.h"

namespace twinbench::hw {

/// A table that must stand while a block is taken.
struct StandingTable {
  std::string name;
  RotaryTable& table;
  double tolerance_rad;     // of encoder against command
  double furthest_rad = 0.0;  // seen off its stop during any block; signed
};

/// An A/D converter that has both tables' encoders looked at while it takes a block, on a thread of its own: at once, and every
/// 20 ms as long as the block lasts. Only for a bench in real time, whose tables are reached by other lines than the converter.
class WatchedAdc : public AdConverter {
 public:
  WatchedAdc(AdConverter& inner, StandingTable target, StandingTable reference)
      : inner_(inner), tables_{std::move(target), std::move(reference)} {}

  /// @throws DeviceFault kMoved if a table stood further from where it was sent than its tolerance; kRestarted if it has lost its
  ///         origin; what a look throws; else as the converter.
  Acquisition Acquire(int n_samples, bool keep_raw) override;
  const std::array<StandingTable, 2>& tables() const { return tables_; }

 private:
  void LookWhile(const std::stop_token& block_lasts);
  void Look(StandingTable& table);

  AdConverter& inner_;
  std::array<StandingTable, 2> tables_;
  std::mutex mutex_;
  std::condition_variable_any ended_;
  std::exception_ptr failure_;  // of a look
};

}  // namespace twinbench::hw
