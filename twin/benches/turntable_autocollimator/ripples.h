#pragma once

#include <string>
#include <vector>

#include "twin/benches/turntable_autocollimator/settings.h"
#include "twin/core/reading.h"
#include "twin/diagnose/by_twin.h"

namespace twinbench::benches::turntable {

using ShownOf = double (*)(const Reading&);

inline double X_rad(const Reading& r) {
  return r.autocollimator_yaw_rad;
}
inline double Y_rad(const Reading& r) {
  return r.autocollimator_tilt_rad;
}

inline bool IsInSweep(const Reading& r) {
  return r.phase == Phase::kCalibration;
}

/// Ripple along an axis: of the stated pixels, within a hundredth, and of any other period that the scatter of the
/// readings does not wash out, each the longest of those that the spacing of the readings cannot tell apart.
void AddRipples(const std::vector<Reading>& readings, const std::string& axis, ShownOf shown_rad, const TurntableSettings& own,
                diagnose::TwinComparison& comparison);

/// Tells with each ripple that was found what other periods look just so at these readings, and what its period is by the
/// reference of a sweep: that of the catalogue goes by what is shown.
void TellPeriods(const std::vector<Reading>& readings, diagnose::Diagnosis& diagnosis);

}  // namespace twinbench::benches::turntable
