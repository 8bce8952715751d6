#pragma once

#include <array>

#include "twin/core/frames.h"
#include "twin/core/reading.h"
#include "twin/core/scenario.h"

namespace twinbench::measure {

/// What the evaluation believes about the rotary bench before it has seen a reading: design values only. Deviations
/// that a scenario may give its bench (roll, gain errors, centring) are for the calibration and the fit to find.
struct BenchGeometry {
  double wavelength_m = kNaN;
  double lines_per_m = kNaN;
  std::array<double, 2> psd_distance_m = {kNaN, kNaN};   // l1 of PSD A and B: laser spot -> centre
  std::array<double, 2> sensitivity_V_m = {kNaN, kNaN};  // of PSD A and B
  Vector3 grating_point_m{kNaN, kNaN, kNaN};             // laser spot, from the reference table's origin
  double reference_height_m = kNaN;                      // reference table's origin above the target table's
  double adc_step_V = 0.0;                               // one bit of the A/D converter; 0: not known
  double hum_V = 0.0, hum_Hz = 50.0;  // amplitude: samples of a block share it, so no scatter shows it
  double scan_s = 0.0;                // from sample to sample of a channel
  double autocollimator_noise_rad = 0.0;
  double autocollimator_gain = 1.0;  // shown over true, both axes, as its certificate says
  std::array<double, 2> ghost_light = {0.0, 0.0};  // on PSD A and B by way of the grating, as a share of its own

  /// sin(theta) of the two nominal orders, at normal incidence.
  double SinTheta() const { return wavelength_m * lines_per_m; }

  /// Laser spot from the target table's origin, in L at zero pose errors [m]; its z is the paper's h0.
  Vector3 SpotFromTarget() const { return grating_point_m + Vector3(0.0, 0.0, reference_height_m); }
};

/// The design values in a scenario.
/// @throws std::logic_error if the nominal order does not exist (wavelength * lines >= 1) or a length is not
/// positive.
BenchGeometry NominalGeometry(const Scenario& scenario);

}  // namespace twinbench::measure
