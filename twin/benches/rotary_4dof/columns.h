#pragma once

#include <string>
#include <vector>

#include "twin/core/reading.h"
#include "twin/core/reading_column.h"

/// Columns without a field of their own in a reading: displacement probes and a tilt meter at an artefact on the target, in
/// the place of grating and PSDs.
namespace twinbench::benches::rotary {

inline constexpr int kMostProbes = 4;

/// What a radial probe showed [m]; from 0.
inline Quantity ProbeRadial_m(int probe) {
  return {"probe_" + std::to_string(probe + 1) + "_um"};
}
inline const Quantity kProbeAxial_m{"probe_axial_um"};
inline const Quantity kProbeTiltX_rad{"probe_tilt_x_arcsec"}, kProbeTiltY_rad{"probe_tilt_y_arcsec"};

/// Whether any reading is a probe's.
bool ShowsProbes(const std::vector<Reading>& readings);

}  // namespace twinbench::benches::rotary
