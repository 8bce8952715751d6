#pragma once

#include "mechanics/stack.h"

/// Quasi-static deflection of the bearings under weight, in Eigen alone and without Bullet.
namespace twinbench::mechanics {

/// Slope of the potential energy of all weights with respect to the coordinates [N, Nm].
Vector12 WeightGradient(const StackParameters& parameters, const Vector12& q);

/// Deflections at which the energy of springs and weights is least, for rotors held at the given angles; the rotor
/// entries hold these angles. Fixed point q = K^-1 (preload - dU/dq); the weights' slope changes by about 1e-4 of
/// the springs', so that every round wins four digits.
Vector12 StaticDeflection(const StackParameters& parameters, double target_rad, double reference_rad);

/// True if no angle changes the deflection: no eccentric payload, no offset and no tilt of the reference's body.
bool SagIsConstant(const StackParameters& parameters);

}  // namespace twinbench::mechanics
