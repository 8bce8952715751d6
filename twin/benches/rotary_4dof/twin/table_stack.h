#pragma once

#include "twin/benches/rotary_4dof/settings.h"
#include "twin/sim/axes.h"

namespace twinbench::sim {

/// @param actual  Outlives what is returned.
inline TableStack RotaryTableStack(const Scenario& actual) {
  const RotarySettings& own = RotaryOf(actual);
  mechanics::ChainGeometry geometry;
  geometry.p_RG_m = own.grating.point_m;
  geometry.reference_height_m = own.reference_height_m;
  geometry.centring_m = own.centring_m;
  geometry.mount_tilt_rad = own.mount_tilt_rad;
  return {own.mechanics, own.target, own.reference, geometry, actual.RunSeed()};
}

}  // namespace twinbench::sim
