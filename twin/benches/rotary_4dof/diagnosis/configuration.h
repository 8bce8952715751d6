#pragma once

#include <vector>

#include "twin/benches/rotary_4dof/estimators/design.h"
#include "twin/benches/rotary_4dof/estimators/geometry.h"
#include "twin/core/reading.h"
#include "twin/core/scenario.h"

namespace twinbench::diagnose::rotary {

/// How bench and tables stood at one used reading, as far as the fit has to know.
struct Configuration {
  int setup = -1;                                    // index into Design::setups; negative: calibration phase
  int target = 0;                                    // position of the target table
  double swept_yaw_rad = 0.0, swept_tilt_rad = 0.0;  // of the calibration's goniometer
};

struct Configurations {
  separate::Design design;
  std::vector<Configuration> of_reading;  // one a used reading
};

/// Finds set-ups and positions in the commanded angles, with the clamping that the scenario and its effects state.
/// The published equations add the reference's wobble as it is (eq. 13), however the grating was clamped.
///
/// @throws InputError if the commanded angles are on no grid.
Configurations FindConfigurations(const std::vector<Reading>& used, const Scenario& scenario,
                                  const measure::BenchGeometry& geometry, bool published);

}  // namespace twinbench::diagnose::rotary
