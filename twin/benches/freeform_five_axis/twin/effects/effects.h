#pragma once

#include "twin/benches/freeform_five_axis/twin/effect.h"
#include "twin/sim/effect_parameter.h"

/// Errors of the machine share a file, and so do faults of the detectors.
namespace twinbench::sim {

using FreeformEffectPointer = std::unique_ptr<FreeformEffect>;

// On the detectors
FreeformEffectPointer MakeGainOrLeakage(const EffectSettings&);
FreeformEffectPointer MakeSpotDrift(const EffectSettings&);
FreeformEffectPointer MakeAxesTurned(const EffectSettings&);
FreeformEffectPointer MakeCameraFault(const EffectSettings&, const Scenario&);
FreeformEffectPointer MakeFreeformSignal(const EffectSettings&, const Scenario&);
// Of the artefact and the machine
FreeformEffectPointer MakeArtefactPitch(const EffectSettings&, const Scenario&);
FreeformEffectPointer MakeArtefactForm(const EffectSettings&, const Scenario&);
FreeformEffectPointer MakeCyclic(const EffectSettings&);
FreeformEffectPointer MakeAxisBacklash(const EffectSettings&);
FreeformEffectPointer MakeThermalGrowth(const EffectSettings&);
FreeformEffectPointer MakeArtefactSlip(const EffectSettings&);
FreeformEffectPointer MakeTone(const EffectSettings&);
FreeformEffectPointer MakeFreeformOutliers(const EffectSettings&, const Scenario&);

}  // namespace twinbench::sim
