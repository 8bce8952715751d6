#pragma once

#include "mechanics/stack.h"

namespace twinbench::mechanics {

/// The default stack with 1.5 kg at 40 mm from the reference's axis.
inline StackParameters EccentricStack() {
  StackParameters p;
  p.payload.mass_kg = 1.5;
  p.payload.radius_m = 0.040;
  return p;
}

}  // namespace twinbench::mechanics
