#include "twin/benches/rotary_4dof/estimators/geometry.h"

#include <cmath>

#include "twin/benches/rotary_4dof/settings.h"
#include "twin/core/errors.h"

namespace twinbench::measure {
namespace {

double AdcStep_V(const Scenario& scenario) {
  return scenario.noise_free ? 0.0 : 2.0 * RotaryOf(scenario).adc.range_V / std::exp2(RotaryOf(scenario).adc.bits);
}

/// What the silicon of a PSD reflects comes back to it from the grating by the second order, and to the other by the zeroth.
std::array<double, 2> GhostLight(const RotarySettings& bench) {
  const double a = bench.psd_a.silicon_reflectance, b = bench.psd_b.silicon_reflectance;
  const auto& [back_a, own_a, across, own_b, back_b] = bench.grating.efficiency;
  return {a * back_a + b * across, b * back_b + a * across};
}

void Check(const BenchGeometry& geometry) {
  Require(geometry.SinTheta() > 0.0 && geometry.SinTheta() < 1.0, "the nominal first order does not exist");
  for (const double l1_m : geometry.psd_distance_m) Require(l1_m > 0.0, "a PSD distance is not positive");
  for (const double V_m : geometry.sensitivity_V_m) Require(V_m > 0.0, "a PSD sensitivity is not positive");
}

}  // namespace

BenchGeometry NominalGeometry(const Scenario& scenario) {
  BenchGeometry geometry;
  geometry.wavelength_m = RotaryOf(scenario).laser.wavelength_m;
  geometry.lines_per_m = RotaryOf(scenario).grating.lines_per_m;
  geometry.psd_distance_m = {RotaryOf(scenario).psd_a.distance_m, RotaryOf(scenario).psd_b.distance_m};
  geometry.sensitivity_V_m = {RotaryOf(scenario).psd_a.sensitivity_V_m, RotaryOf(scenario).psd_b.sensitivity_V_m};
  geometry.grating_point_m = RotaryOf(scenario).grating.point_m;
  geometry.reference_height_m = RotaryOf(scenario).reference_height_m;
  geometry.adc_step_V = AdcStep_V(scenario);
  if (!scenario.noise_free) geometry.hum_V = RotaryOf(scenario).amplifier.hum_V;
  geometry.hum_Hz = RotaryOf(scenario).amplifier.hum_Hz;
  geometry.scan_s = kChannels / RotaryOf(scenario).adc.rate_Hz;
  geometry.autocollimator_noise_rad = RotaryOf(scenario).autocollimator.noise_rad;
  geometry.autocollimator_gain = 1.0 + RotaryOf(scenario).autocollimator.gain_error;
  geometry.ghost_light = GhostLight(RotaryOf(scenario));
  Check(geometry);
  return geometry;
}

}  // namespace twinbench::measure
