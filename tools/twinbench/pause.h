#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <string>

#include "twin/procedure/standstill.h"

namespace twinbench::tools {

/// Whether what a run moves stands; asked between two readings. None: nothing but a twin's time goes on, and it stands while nobody asks.
using StandingCheck = std::function<procedure::Standstill()>;

/// Holds a run between two readings for as long as somebody wishes.
class Pause {
 public:
  /// What is to be told; called on the thread that measures.
  struct Ears {
    std::function<void(int reading)> paused;                      // it stands, behind so many readings
    std::function<void(const std::string& why)> not_yet;          // it does not, and the run goes on to the next reading
    std::function<void(const std::string& why)> restless;         // something moves that stood
    std::function<void(int reading)> resumed;                     // or stopped
  };
  explicit Pause(Ears ears) : ears_(std::move(ears)) {}

  /// From any thread.
  void Ask(bool pauses) { is_wanted_ = pauses; }

  /// Behind reading `reading`: returns at once unless a pause is asked for and everything stands; then when it is over or a stop is asked
  /// for. Looks every half second. A controller that does not answer counts as one that moves; what is wrong with it the next move finds out.
  void HoldIfAsked(int reading, const StandingCheck& stands, const std::function<bool()>& stop_asked);

 private:
  void HoldWhileWanted(const StandingCheck& stands, const std::function<bool()>& stop_asked);

  Ears ears_;
  std::atomic<bool> is_wanted_ = false;
  std::chrono::steady_clock::time_point refused_{};  // when it did not stand, last
};

}  // namespace twinbench::tools
