#include "twin/measure/geometry.h"

#include <cmath>

#include "twin/core/errors.h"

namespace twinbench::measure {
namespace {

double AdcStep_V(const Scenario& scenario) {
  return scenario.noise_free ? 0.0 : 2.0 * scenario.adc.range_V / std::exp2(scenario.adc.bits);
}

void Check(const BenchGeometry& geometry) {
  Require(geometry.SinTheta() > 0.0 && geometry.SinTheta() < 1.0, "the nominal first order does not exist");
  for (const double l1_m : geometry.psd_distance_m) Require(l1_m > 0.0, "a PSD distance is not positive");
  for (const double V_m : geometry.sensitivity_V_m) Require(V_m > 0.0, "a PSD sensitivity is not positive");
}

}  // namespace

BenchGeometry NominalGeometry(const Scenario& scenario) {
  BenchGeometry geometry;
  geometry.wavelength_m = scenario.laser.wavelength_m;
  geometry.lines_per_m = scenario.grating.lines_per_m;
  geometry.psd_distance_m = {scenario.psd_a.distance_m, scenario.psd_b.distance_m};
  geometry.sensitivity_V_m = {scenario.psd_a.sensitivity_V_m, scenario.psd_b.sensitivity_V_m};
  geometry.grating_point_m = scenario.grating.point_m;
  geometry.reference_height_m = scenario.reference_height_m;
  geometry.adc_step_V = AdcStep_V(scenario);
  geometry.autocollimator_noise_rad = scenario.autocollimator.noise_rad;
  Check(geometry);
  return geometry;
}

}  // namespace twinbench::measure
