#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "twin/core/devices.h"

/// What was asked of a bench and what it answered, as text that keeps every bit. A list of calls is enough to bring
/// a simulated bench to where it was, and to play a run back without any bench.
namespace twinbench {

struct DeviceCall {
  Time time{};  // of the bench, when it had answered
  std::string
      device;  // "clock", "target", "reference", "adc", "autocollimator", "thermometer", "goniometer", "fixture"
  std::string request;  // "move 0.17453292519943295"
  std::string answer;   // empty where there is none

  friend bool operator==(const DeviceCall&, const DeviceCall&) = default;
};

/// The answer to a call. A block of the A/D converter comes beside the text, for its raw counts are not in it.
struct CallAnswer {
  std::string text;
  Acquisition block;
};

/// Carries out one request on a bench.
/// @throws InputError if it is none; what the device throws.
CallAnswer Perform(RotaryBench& bench, const std::string& device, const std::string& request);

/// The block that the text of an answer to "acquire" tells of; without raw counts.
/// @throws InputError if it tells of none.
Acquisition ParseBlock(const std::string& answer);

/// A rotary bench every call of which is a question to somebody: the devices of a journal or of a recording.
class AskedBench {
 public:
  using Ask = std::function<CallAnswer(const std::string& device, const std::string& request)>;
  /// @param now         What the clock shows.
  /// @param simulation  Handed on; may be none.
  AskedBench(Ask ask, std::function<Time()> now, Simulation* simulation);
  ~AskedBench();
  RotaryBench Bench();

 private:
  struct Devices;
  std::unique_ptr<Devices> devices_;
  Simulation* simulation_;
};

}  // namespace twinbench
