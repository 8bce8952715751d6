#pragma once

#include <memory>

#include "twin/benches/turntable_autocollimator/twin/effect.h"
#include "twin/sim/effect_parameter.h"

/// Causes of the turntable bench: wrong constants of the bench share a file, and so do zeros that move in time and
/// the ways in which the turntable stands elsewhere.
namespace twinbench::sim {

using TurntableEffectPointer = std::unique_ptr<TurntableEffect>;

TurntableEffectPointer MakeAutocollimatorSignal(const EffectSettings&, const Scenario&);
TurntableEffectPointer MakeWrongConstant(const EffectSettings&);  // autocollimator_scale, multitooth_seating
TurntableEffectPointer MakePixelPeriod(const EffectSettings&);  // autocollimator_periodic
/// autocollimator_drift, mount_creep, slip, tone
TurntableEffectPointer MakeMovingZero(const EffectSettings&);
TurntableEffectPointer MakeTurntableBacklash(const EffectSettings&);
TurntableEffectPointer MakeTurntableSettling(const EffectSettings&);
TurntableEffectPointer MakeAutocollimatorOutliers(const EffectSettings&, const Scenario&);

/// `value` on the axis that the effect names.
inline Eigen::Vector2d OnAxis(const std::string& where, double value) {
  return where == "x" ? Eigen::Vector2d(value, 0.0) : Eigen::Vector2d(0.0, value);
}

}  // namespace twinbench::sim
