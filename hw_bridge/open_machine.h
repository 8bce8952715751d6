#pragma once

#include <functional>
#include <memory>

#include "hw_bridge/machine_file.h"

namespace twinbench::hw {

/// The devices of a bench with a machine, connected and identified; closed when this goes.
class OpenMachine : public MachineDevices {
 public:
  /// Who answered; the record keeps it.
  virtual std::string Identity() const = 0;
  /// As OpenBench::HearClock.
  virtual void HearClock(std::function<void(const std::string&)> /*listener*/) {}
  /// Soft limits that the bench file and the controller agree on, one entry an axis.
  virtual std::vector<AxisLimits> Limits() const = 0;
};

/// Opens a bench of kind "hardware".
/// @param columns  What its instruments may show.
/// @param elapsed  Time 0 of the run was so long ago (a resumed run); 0 for a new one.
/// @param run      Which run of its bench a served twin makes, as Scenario::repeat; 0: its own.
/// @param stop_asked  Heard by every device, as DeviceLine::HearStop; none: nobody stops them.
/// @throws DeviceFault if a device does not answer, is not the one named or allows less than the file; InputError
/// if
///         an instrument is said to show what the bench has not.
std::unique_ptr<OpenMachine> OpenMachineHardware(const MachineFile& file, const std::vector<MachineAxis>& axes,
                                                 const std::vector<ReadingColumn>& columns, Duration elapsed = {},
                                                 int run = 0, const std::function<bool()>& stop_asked = {});

}  // namespace twinbench::hw
