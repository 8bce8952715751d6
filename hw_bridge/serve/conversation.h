#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <utility>

#include "hw_bridge/serve/input_buffer.h"

namespace twinbench::hw {

using WallClock = std::chrono::steady_clock;
/// What it shows; a test has a wall of its own.
using Wall = std::function<WallClock::time_point()>;

/// What a conversation wants done before it is asked again.
struct Step {
  enum class Kind {
    kRead,     // more input
    kSend,     // `bytes` out
    kWait,     // let `wait` pass
    kSilence,  // nothing more, ever; the connection stays
    kClose     // `bytes` out, then the end
  };
  Kind kind = Kind::kRead;
  std::string bytes;
  WallClock::duration wait{};

  static Step Read() { return {}; }
  static Step Send(std::string text) { return {Kind::kSend, std::move(text), {}}; }
  static Step Wait(WallClock::duration duration) { return {Kind::kWait, {}, duration}; }
  static Step Silence() { return {Kind::kSilence, {}, {}}; }
  static Step Close(std::string text = {}) { return {Kind::kClose, std::move(text), {}}; }
};

/// One client's side of a protocol, as a machine that a session turns: it never blocks and holds at most one
/// answer.
class Conversation {
 public:
  virtual ~Conversation() = default;
  virtual Step Next(InputBuffer& input) = 0;
};

/// An operation that takes time: asked again and again until it has its answer (empty: done, nothing to say).
using Poll = std::function<std::optional<std::string>()>;

inline constexpr WallClock::duration kPollEvery = std::chrono::milliseconds(2);

}  // namespace twinbench::hw
