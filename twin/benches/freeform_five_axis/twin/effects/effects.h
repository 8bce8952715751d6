#pragma once

#include "twin/benches/freeform_five_axis/twin/effect.h"
#include "twin/sim/effect_parameter.h"

/// Constants that are wrong share a file, and so do errors of the machine and faults of the detectors.
namespace twinbench::sim {

using FreeformEffectPointer = std::unique_ptr<FreeformEffect>;

/// A constant of probe or artefact times 1 + ratio.
FreeformEffectPointer MakeWrongProbe(const EffectSettings&);
// On the detectors
FreeformEffectPointer MakeGainOrLeakage(const EffectSettings&);
FreeformEffectPointer MakeSpotDrift(const EffectSettings&);
FreeformEffectPointer MakeAxesTurned(const EffectSettings&);
FreeformEffectPointer MakeCameraFault(const EffectSettings&);
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
