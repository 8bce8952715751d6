#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "twin/core/machine.h"

/// What was asked of a bench with a machine and what it answered, as text that keeps every bit: device_call.h says the same
/// of a rotary bench. Devices: "clock", "machine", "instruments", "indexer", "fixture".
namespace twinbench {

/// What stands in a record's calls beside those of devices. The way begins, for the first time or behind a fault; the answer
/// says on what.
inline constexpr const char *kRunDevice = "run", *kAttemptBegins = "begin";
inline constexpr const char *kOnSimulation = "simulation", *kOnRealBench = "bench";
/// The clock was looked at and had gone on since the last call; the time of this call is the answer.
inline constexpr const char *kClockDevice = "clock", *kClockShows = "shows";

/// Carries out one request on such a bench.
/// @param shown  InstrumentColumns of the bench: a sample keeps these, its time and its status.
/// @return the answer; empty where there is none.
/// @throws InputError if it is no request; what the device throws.
std::string Perform(MachineBench& bench, const std::vector<ReadingColumn>& shown, const std::string& device,
                    const std::string& request);

/// A bench with a machine every call of which is a question to somebody: the devices of a journal or of a recording.
class AskedMachine {
 public:
  using Ask = std::function<std::string(const std::string& device, const std::string& request)>;
  /// What is the same all along and is not asked.
  struct Parts {
    std::vector<MachineAxis> axes;
    std::vector<ReadingColumn> shown;  // as above
    bool has_indexer = false;
    Simulation* simulation = nullptr;  // handed on
  };
  /// @param now  What the clock shows.
  AskedMachine(Ask ask, std::function<Time()> now, Parts parts);
  ~AskedMachine();
  MachineBench Bench();

 private:
  struct Devices;
  std::unique_ptr<Devices> devices_;
};

}  // namespace twinbench
