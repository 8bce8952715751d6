#pragma once

#include <memory>

#include "twin/benches/rotary_4dof/settings.h"
#include "twin/benches/rotary_4dof/twin/effect.h"
#include "twin/sim/effect_parameter.h"

/// One file a cause; the names are those of formats.md. Parameters are in SI, by their name in the catalogue.
namespace twinbench::sim {

using EffectPointer = std::unique_ptr<Effect>;

EffectPointer MakeSignal(const EffectSettings&, const Scenario&);
EffectPointer MakeModeHop(const EffectSettings&, const Scenario&);
EffectPointer MakeIncidenceOffset(const EffectSettings&, const Scenario&);
EffectPointer MakeLaserDrift(const EffectSettings&, const Scenario&);
EffectPointer MakeMountCreep(const EffectSettings&, const Scenario&);
EffectPointer MakeThermalTilt(const EffectSettings&, const Scenario&);
EffectPointer MakeEncoderSubdivision(const EffectSettings&, const Scenario&);
EffectPointer MakeBacklash(const EffectSettings&, const Scenario&);
EffectPointer MakeSettling(const EffectSettings&, const Scenario&);
EffectPointer MakeReclampFrame(const EffectSettings&, const Scenario&);
EffectPointer MakeBearingHalfFrequency(const EffectSettings&, const Scenario&);
EffectPointer MakeTone(const EffectSettings&, const Scenario&);
EffectPointer MakeSlip(const EffectSettings&, const Scenario&);
EffectPointer MakeAdcStep(const EffectSettings&, const Scenario&);
EffectPointer MakeCrosstalk(const EffectSettings&, const Scenario&);
EffectPointer MakeOutliers(const EffectSettings&, const Scenario&);
EffectPointer MakeConvention(const EffectSettings&, const Scenario&);
EffectPointer MakeEmpirical(const EmpiricalSettings&, const Scenario&);  // an [[empirical]] block

/// Index of a channel by its name ("psd_a_x"). @throws std::logic_error if there is none.
int ChannelIndex(const std::string& name);

}  // namespace twinbench::sim
