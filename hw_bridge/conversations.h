#pragma once

#include <functional>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "hw_bridge/bench_file.h"
#include "hw_bridge/control/device_line.h"

namespace twinbench::hw {

/// The conversations of a bench: one for every address.
class Conversations {
 public:
  /// @param stop_asked  Heard by all of them, as DeviceLine::HearStop; none: nobody stops them.
  explicit Conversations(std::function<bool()> stop_asked = {}) : stop_asked_(std::move(stop_asked)) {}
  /// The part of `device` in it, connected and identified.
  DeviceLine LineOf(const std::string& device, const ControlSettings& settings);
  std::set<std::string> Identities() const;

 private:
  std::function<bool()> stop_asked_;
  std::map<std::string, Dialogue> by_address_;
};

}  // namespace twinbench::hw
