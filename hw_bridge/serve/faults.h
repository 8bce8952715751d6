#pragma once

#include <deque>
#include <initializer_list>
#include <string>
#include <string_view>

/// Faults on demand: what a client asked the served bench to suffer (docs/protocols.md lists the kinds).
namespace twinbench::hw {

// clang-format off
enum class Injected {
  kNone,
  kDrop, kStall, kShort, kError, kGap, kSaturate, kFloat, kStuck, kHum, kSlip, kNoLight,  // blocks
  kStep, kPpm,                                                                            // their time stamps
  kMute, kLate, kPartial, kDisconnect,                                                    // answers
  kRestart,                                                                               // controllers
  kLostStep, kNotInPosition, kLimit, kStandStill                                          // moves
};
// clang-format on

class Faults {
 public:
  /// @return false if there is no such device or kind, or the count is not within 1..1e6, or too many wait already.
  bool Add(std::string_view device, std::string_view kind, long long count);
  /// The same from "<kind>" or "<kind>,<count>".
  bool Add(std::string_view device, std::string_view kind_and_count);

  /// The fault that strikes now, or kNone; it is used up.
  Injected TakeBlock() { return Take({"adc"}, Injected::kDrop, Injected::kNoLight); }
  Injected TakeStamp() { return Take({"clock"}, Injected::kStep, Injected::kPpm); }
  Injected TakeAnswer(std::string_view table) {
    return Take({table, "controller"}, Injected::kMute, Injected::kDisconnect);
  }
  Injected TakeRestart(std::string_view table) { return Take({table}, Injected::kRestart, Injected::kRestart); }
  Injected TakeMove(std::string_view table) {
    return Take({table, "controller"}, Injected::kLostStep, Injected::kStandStill);
  }

  Injected TakeLatch(std::string_view instruments) { return Take({instruments}, Injected::kGap, Injected::kGap); }

  /// "adc,drop,2;target,mute,1"
  std::string Waiting() const;

 private:
  struct Entry {
    std::string device, name;
    Injected kind;
    long long count;
  };
  Injected Take(std::initializer_list<std::string_view> devices, Injected first, Injected last);

  std::deque<Entry> waiting_;
};

}  // namespace twinbench::hw
