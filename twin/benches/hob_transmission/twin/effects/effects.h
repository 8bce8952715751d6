#pragma once

#include <memory>

#include "twin/benches/hob_transmission/twin/effect.h"
#include "twin/sim/effect_parameter.h"

/// Causes of the hobbing machine: those of one kind share a file.
namespace twinbench::sim {

using HobEffectPointer = std::unique_ptr<HobEffect>;

HobEffectPointer MakeHobSignal(const EffectSettings&, const Scenario&);
HobEffectPointer MakeRingError(const EffectSettings&);  // eccentricity, ellipticity, periodic
HobEffectPointer MakeHobSignalFault(const EffectSettings&);
HobEffectPointer MakeGearError(const EffectSettings&, const Scenario&);  // hob_runout, worm, gear_mesh
HobEffectPointer MakeWindUp(const EffectSettings&);  // hysteresis
/// drift, slip, tone, latency
HobEffectPointer MakeShownError(const EffectSettings&);
HobEffectPointer MakeCounterOutliers(const EffectSettings&, const Scenario&);

}  // namespace twinbench::sim
