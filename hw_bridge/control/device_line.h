#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <vector>

#include "hw_bridge/control/dialogue.h"

namespace twinbench::hw {

/// One device's part in a conversation: its name in every message, its deadline, its answers strictly read. Does
/// not own the dialogue.
class DeviceLine {
 public:
  DeviceLine(Dialogue& dialogue, std::string device, Duration timeout)
      : dialogue_(&dialogue), device_(std::move(device)), timeout_(timeout) {}

  /// @param beyond  The answer may take so much longer than the timeout.
  /// @throws DeviceFault as Dialogue::Ask.
  std::string Ask(const std::string& query, Duration beyond = {});
  /// From here on `stop_asked` is asked before every question and every 50 ms while an answer is waited for, so that nothing is begun behind
  /// it, however slowly the device answers. It is heard once, or was when SayFirst was called: what is said behind it brings the device to
  /// rest.
  void HearStop(std::function<bool()> stop_asked) { stop_asked_ = std::move(stop_asked); }
  bool HearsStop() const { return static_cast<bool>(stop_asked_); }
  /// @throws DeviceFault kStopped if the operator said so.
  void RequireGoingOn();
  /// Says something that is not answered.
  void Tell(const std::string& command) { dialogue_->Tell(device_, command + "\n", Patience()); }
  /// Says, before anything else, what cannot wait (Dialogue::SayFirst); for some seconds from here on no answer is waited for longer
  /// than one.
  /// @param command  Empty: nothing is said first.
  void SayFirst(const std::string& command);
  /// @throws DeviceFault kProtocol too, unless the whole answer is the number.
  double AskNumber(const std::string& query, double to_SI);
  long long AskWholeNumber(const std::string& query, Duration beyond = {});
  std::string NextLine();

  /// Makes sure of the connection. @return how many times it has been opened.
  int Openings();
  const std::string& device() const { return device_; }
  const std::string& identity() const { return dialogue_->identity(); }

  [[noreturn]] void Fail(FaultKind kind, const std::string& why) const;
  /// Stops the device first. Why it was stopped is what is told, also when it cannot be reached any more.
  [[noreturn]] void StopAndFail(const std::function<void()>& stop, FaultKind kind, const std::string& why) const;
  /// `answer` is none to `query`: whatever else comes on this connection cannot be trusted, so it is closed.
  [[noreturn]] void FailProtocol(const std::string& query, const std::string& answer, const std::string& expected);

 private:
  Duration Patience() const;

  Dialogue* dialogue_;
  std::string device_;
  Duration timeout_;
  std::function<bool()> stop_asked_;
  bool has_heard_ = false;
  std::chrono::steady_clock::time_point hurries_until_{};
};

}  // namespace twinbench::hw
