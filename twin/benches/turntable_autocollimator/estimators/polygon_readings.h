#pragma once

#include <vector>

#include "twin/core/reading.h"
#include "twin/core/scenario.h"

/// The turntable bench with a polygon: what each nulled face says.
namespace twinbench::separate::turntable {

/// One face in one clamping of the polygon.
struct FaceReading {
  int clamping = 0;  // number of the set-up
  int face = 0;
  int direction = 1;
  double angle_rad = kNaN;  // nominal, of the turntable
  double value_rad = kNaN;  // error of the turntable there + error of the face + constant of the clamping
};

/// value = x - (encoder - nominal angle), x as the autocollimator shows it without its stated scale and roll and
/// without what the stated flatness of the faces makes of the stated eccentricity, and the polygon's tilt, as y shows
/// it, in second order (docs/theory.md 5.3 to 5.5).
///
/// Readings without numbers are left out.
/// @throws InputError if a set-up has no offset in the scenario, or the encoder shows another face than the reading
///         names.
std::vector<FaceReading> FaceReadings(const std::vector<Reading>& readings, const Scenario& scenario);

}  // namespace twinbench::separate::turntable
