#pragma once

#include "twin/diagnose/diagnosis.h"

namespace twinbench::benches::hob {

/// Notes that gears which err as often per turn of the hob as its ring is said to do show the same: two encoders see their
/// difference alone.
void TellGearsBesideRing(diagnose::Diagnosis& diagnosis);

}  // namespace twinbench::benches::hob
