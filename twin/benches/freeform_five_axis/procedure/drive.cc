#include "twin/benches/freeform_five_axis/procedure.h"

#include <fmt/format.h>

#include "twin/benches/freeform_five_axis/columns.h"
#include "twin/core/device_fault.h"
#include "twin/core/units.h"

namespace twinbench::procedure {
namespace {

using benches::freeform::kCommanded;

std::string MountInWords(const MountSettings& mount) {
  return fmt::format("artefact at X {:.6g}, Y {:.6g}, Z {:.6g} mm, yaw {:.6g} deg", mount.x_m / units::mm,
                     mount.y_m / units::mm, mount.z_m / units::mm, mount.yaw_rad / units::deg);
}

void RequireFiveAxes(const std::vector<MachineAxis>& axes) {
  bool fits = axes.size() == kMachineAxes;
  for (std::size_t k = 0; fits && k < kMachineAxes; ++k)
    fits = axes[k].is_rotary == IsRotaryAxis(static_cast<int>(k));
  if (!fits)
    throw DeviceFault(FaultKind::kRefused, "machine",
                      "poses are driven with X, Y and Z linear, then A and B rotary");
}

std::vector<double> PlannedPlace(const Reading& reading) {
  std::vector<double> pose;
  for (const auto& axis : kCommanded) pose.push_back(axis(reading));
  return pose;
}

void GoThroughPoses(MachineSequencer& sequencer, const FreeformProcedureSettings& settings) {
  RequireFiveAxes(sequencer.axes());
  const int count = static_cast<int>(sequencer.plan().size());
  for (int k = sequencer.From(0, count); k < count; ++k) {
    const Reading& planned = sequencer.plan()[static_cast<std::size_t>(k)];
    if (sequencer.NeedsMounting(planned.setup)) {
      sequencer.Clear();
      sequencer.Mount(planned.setup, MountInWords(settings.mounts[static_cast<std::size_t>(planned.setup)]));
      if (planned.setup > 0) sequencer.Rest(k, FromSeconds(settings.remount_s));
    }
    sequencer.MoveTo(PlannedPlace(planned));
    sequencer.TakeAtRest(k, Duration(0));
  }
}

}  // namespace

void DriveFreeform(MachineBench& bench, const Scenario& scenario, ReadingSink& sink,
                   const ProgressCallback& progress, const MachineOptions& options) {
  const MachinePlan plan{FreeformSchedule(scenario), scenario.bench, {}};
  const auto way = [&](MachineSequencer& s) { GoThroughPoses(s, FreeformOf(scenario).freeform_procedure); };
  CarryOutPlan(bench, plan, way, sink, progress, options);
}

}  // namespace twinbench::procedure
