#pragma once

#include <string>

#include "hw_bridge/serve/conversation.h"
#include "hw_bridge/serve/iiod_buffer.h"

namespace twinbench::hw {

/// What most commands answer: 0, a count, or an errno below zero.
inline Step NumberLine(int number) {
  return Step::Send(std::to_string(number) + "\n");
}

/// One READBUF: collects its block, waits for the wall clock if time is held, sends it in pieces; with whatever
/// fault strikes it.
class IiodDelivery {
 public:
  /// @param bytes  Asked for; at least one scan. What is left over behind the last whole scan is served short.
  IiodDelivery(ServedBench& served, IiodBuffer& buffer, std::size_t bytes);
  /// What to do next. Once Done, that was the last.
  Step Next();
  bool Done() const { return state_ == State::kDone; }

 private:
  enum class State { kRefused, kCollecting, kAnnouncing, kSending, kDone };
  Step Collect();
  Step Announce();
  Step Send(std::string bytes);
  Step End();

  ServedBench& served_;
  IiodBuffer& buffer_;
  std::size_t scan_bytes_, asked_bytes_, scans_;
  std::size_t sent_ = 0;  // scans
  std::size_t end_;       // scan at which the block ends for the client
  State state_ = State::kCollecting;
  Injected fault_ = Injected::kNone;
};

}  // namespace twinbench::hw
