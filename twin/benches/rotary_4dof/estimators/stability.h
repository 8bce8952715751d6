#pragma once

#include <vector>

#include "twin/benches/rotary_4dof/estimators/geometry.h"
#include "twin/benches/rotary_4dof/estimators/motion.h"

namespace twinbench::measure {

/// What the resting bench did during a stability test; 4-vectors are [ez rad, ex rad, ey rad, dy m].
struct Stability {
  int readings = 0;  // valid ones
  int left_out = 0;  // invalid ones
  double duration_s = kNaN;
  Vector4 range = Vector4::Constant(kNaN);        // largest - smallest
  Vector4 deviation = Vector4::Constant(kNaN);    // standard deviation
  Vector4 u_deviation = Vector4::Constant(kNaN);  // of `deviation`, from the number of readings
  Vector4 noise = Vector4::Constant(kNaN);        // what the readings' own noise explains of `deviation`
  /// Change of wavelength that would look like `range` of dy: the two orders move apart as if the grating came
  /// nearer.
  double wavelength_range_m = kNaN;
};

/// Summarises the motions of the stability phase; all NaN with fewer than two valid ones.
///
/// Uncertainty: `range` grows slowly with the number of readings even for pure noise; compare with `noise`.
/// Reference: Jywe et al. (2007), section 4.2; wavelength: d theta = rho d lambda / cos theta, dy = l1 d theta /
/// sin theta.
Stability SummariseStability(const std::vector<Motion>& motions, const BenchGeometry& geometry);

/// Apparent dy per metre of wavelength change, to first order (negative: a longer wave looks like a retreat).
double DisplacementPerWavelength(const BenchGeometry& geometry);

}  // namespace twinbench::measure
