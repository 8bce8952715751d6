#pragma once

#include <memory>

#include "twin/benches/encoder_comparison/twin/effect.h"
#include "twin/sim/effect_parameter.h"

/// One file a cause; errors that repeat with the angle share one, and so do faults of the signals.
namespace twinbench::sim {

using AngleEffectPointer = std::unique_ptr<AngleEffect>;

AngleEffectPointer MakeAngleSignal(const EffectSettings&, const Scenario&);
AngleEffectPointer MakeHarmonic(const EffectSettings&, double order);  // locked to the device's angle
AngleEffectPointer MakeSignalFault(const EffectSettings&);
AngleEffectPointer MakeLatency(const EffectSettings&);
AngleEffectPointer MakeClockRate(const EffectSettings&);  // a latency that grows
AngleEffectPointer MakeAccelerationError(const EffectSettings&);
AngleEffectPointer MakeFriction(const EffectSettings&);
AngleEffectPointer MakeGap(const EffectSettings&);        // backlash of the device's shaft
AngleEffectPointer MakeHysteresis(const EffectSettings&);
AngleEffectPointer MakeSettling(const EffectSettings&);
AngleEffectPointer MakeScale(const EffectSettings&);
AngleEffectPointer MakeZeroDrift(const EffectSettings&);
AngleEffectPointer MakeZeroTemperature(const EffectSettings&);
AngleEffectPointer MakeZeroSlip(const EffectSettings&);
AngleEffectPointer MakeReferenceFault(const EffectSettings&);
AngleEffectPointer MakeAngleOutliers(const EffectSettings&, const Scenario&);

}  // namespace twinbench::sim
