#pragma once

#include <map>
#include <set>

#include "hw_bridge/bench_file.h"
#include "hw_bridge/control/device_line.h"

namespace twinbench::hw {

/// The conversations of a bench: one for every address.
class Conversations {
 public:
  /// The part of `device` in it, connected and identified.
  DeviceLine LineOf(const std::string& device, const ControlSettings& settings);
  std::set<std::string> Identities() const;

 private:
  std::map<std::string, Dialogue> by_address_;
};

}  // namespace twinbench::hw
