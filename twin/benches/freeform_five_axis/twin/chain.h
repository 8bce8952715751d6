#pragma once

#include <array>

#include "twin/benches/freeform_five_axis/settings.h"
#include "twin/core/frames.h"

/// The bodies of the five-axis machine, exact. Frames: M the machine's, right-handed, Z up; T the tool, its origin
/// the nominal laser spot, the beam along -z; S the X slide; F the artefact (form).
namespace twinbench::sim {

/// Commanded coordinates X, Y, Z [m], A, B [rad].
using MachineCommand = std::array<double, kMachineAxes>;

/// tx, ty, tz [m], rx, ry, rz [rad] of one body.
using BodyError = std::array<double, kBodyErrors>;

/// Every error of the machine at one instant.
struct MachineErrors {
  std::array<BodyError, kMachineAxes> body{};
  std::array<double, kSquarenesses> squareness_rad{};
};

/// translation(tx, ty, tz) Rz(rz) Ry(ry) Rx(rx)
Pose PoseOf(const BodyError& error);

/// The cubics at these coordinates.
MachineErrors ErrorsAt(const MachineSettings& machine, const MachineCommand& at);

/// Tool in the machine.
Pose X_MT(const MachineCommand& at, const MachineErrors& errors, double pivot_m);

/// X slide in the machine.
Pose X_MS(const MachineCommand& at, const MachineErrors& errors);

/// Artefact on the X slide.
Pose X_SF(const MountSettings& mount, const BodyError& error);

}  // namespace twinbench::sim
