#include "hw_bridge/control/operator_devices.h"

#include <fmt/format.h>

#include "twin/core/device_fault.h"
#include "twin/core/units.h"

namespace twinbench::hw {

void Operator::DoAndConfirm(const std::string& device, const std::string& what) {
  *out_ << what << "\nEnter when it is done, \"stop\" to end the run: " << std::flush;
  std::string answer;
  if (!std::getline(*in_, answer)) throw DeviceFault(FaultKind::kStopped, device, "nobody is at the console");
  if (answer == "stop") throw DeviceFault(FaultKind::kStopped, device, "the operator said stop");
}

void ConsoleFixture::Mount(int setup, double clamp_rad, double reseat_rad) {
  hands_.DoAndConfirm("fixture",
                      fmt::format("Mounting {}: clamp the grating {:.4f} deg back on the reference's rotor, seat the "
                                  "reference's body at {:.4f} deg on the target.",
                                  setup, clamp_rad / units::deg, reseat_rad / units::deg));
}

void ConsoleMachineFixture::Clear() {
  hands_.DoAndConfirm("fixture", "Take off what is mounted; the axes will move freely.");
}

void ConsoleMachineFixture::Mount(int setup, const std::string& what) {
  hands_.DoAndConfirm("fixture", fmt::format("Mounting {}: mount {}.", setup, what));
}

void ConsoleIndexer::IndexTo(int tooth, double angle_rad) {
  hands_.DoAndConfirm("indexer",
                      fmt::format("Lift the multi-tooth table, turn it to tooth {} ({:.6g} deg) and seat it.", tooth,
                                  angle_rad / units::deg));
}

void ConsoleGoniometer::MoveTo(double yaw_rad, double tilt_rad) {
  hands_.DoAndConfirm("goniometer", fmt::format("Turn the grating to yaw {:.2f} arcsec, tilt {:.2f} arcsec.",
                                                yaw_rad / units::arcsec, tilt_rad / units::arcsec));
}

}  // namespace twinbench::hw
