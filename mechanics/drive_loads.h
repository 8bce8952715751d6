#pragma once

#include "mechanics/stack.h"

/// What pulls at the tables besides bearings, weight and controllers.
namespace twinbench::mechanics {

/// Whether the parameters have any.
bool HasLoads(const StackParameters& parameters);

/// Generalised forces [N, Nm] on the twelve coordinates:
///
///   cables     on each rotor, against its stator: -stiffness angle - torque sin(angle - azimuth)
///   unbalance  on each rotor, U W^2 radially towards the heavy side, U = mass x radius, W the rotor's speed in the
///              laboratory; the reference's goes through the target's bearing too, with its lever. The weight of U
///              is not here: a payload has one.
///
/// @param rotors_rad    Unwrapped angles of the rotors, target first.
/// @param speeds_rad_s  Of each rotor against its stator.
Vector12 DriveLoads(const StackParameters& parameters, const Eigen::Vector2d& rotors_rad,
                    const Eigen::Vector2d& speeds_rad_s);

}  // namespace twinbench::mechanics
