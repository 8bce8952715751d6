#pragma once

#include <string>
#include <vector>

#include "twin/core/device_call.h"

namespace twinbench::hw {

/// The calls of a recorded run, one after the other.
class RecordedCalls {
 public:
  /// @throws InputError if there are none: an imported file.
  RecordedCalls(std::string folder, std::vector<DeviceCall> calls);

  bool AtEnd() const { return next_ == calls_.size(); }
  /// The next call; not at the end.
  const DeviceCall& Ahead() const { return calls_[next_]; }
  /// Takes the next call, which must be this one.
  /// @throws BenchError if it is another, or if there is none.
  const DeviceCall& Next(const std::string& device, const std::string& request);
  /// Goes on with the call of that number.
  void GoTo(std::size_t number) { next_ = number; }
  const std::vector<DeviceCall>& all() const { return calls_; }

 private:
  std::string folder_;
  std::vector<DeviceCall> calls_;
  std::size_t next_ = 0;
};

}  // namespace twinbench::hw
