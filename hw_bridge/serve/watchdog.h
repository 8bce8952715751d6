#pragma once

#include <map>

#include "hw_bridge/serve/conversation.h"

namespace twinbench::hw {

/// Whether those who move something are still there. A client that armed it is missed when its connection ends, and all of them
/// together when none has said a word for the shortest of their times: they are parts of one program, which talks now to one device
/// and now to the other.
class Watchdog {
 public:
  explicit Watchdog(Wall wall = WallClock::now) : wall_(std::move(wall)) {}
  /// @param who  Any address that identifies a client. @param patience  Zero: no more.
  void Arm(const void* who, WallClock::duration patience);
  WallClock::duration PatienceOf(const void* who) const;
  /// The client's connection has ended. @return whether it is missed.
  bool Leave(const void* who) { return armed_.erase(who) > 0; }
  /// Something was said, or is still being answered, on the connection of a client.
  void Hear(const void* who);
  /// Whether silence has lasted too long; once for every silence.
  bool IsMissingThem();

 private:
  std::map<const void*, WallClock::duration> armed_;
  Wall wall_;
  WallClock::time_point heard_ = wall_();
  bool told_ = false;
};

}  // namespace twinbench::hw
