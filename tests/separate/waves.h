#pragma once

#include <Eigen/LU>
#include <cmath>

#include "twin/core/units.h"
#include "twin/separate/series.h"

/// Waves of which tests make the errors of devices, rings and transmissions, and how far orders that were found are from them.
namespace twinbench::test {

namespace harmonics = separate::harmonics;

/// amplitude cos(order angle + phase)
struct Wave {
  int order;
  double amplitude_arcsec, phase_rad;
};

/// Sum of the waves [rad].
inline double ValueOf(const std::vector<Wave>& waves, double angle_rad) {
  double value = 0.0;
  for (const Wave& w : waves) value += w.amplitude_arcsec * std::cos(w.order * angle_rad + w.phase_rad);
  return value * units::arcsec;
}

/// Wave `order` as a complex coefficient [rad].
inline harmonics::Complex CoefficientOf(const std::vector<Wave>& waves, int order) {
  harmonics::Complex sum = 0.0;
  for (const Wave& w : waves) sum += w.order == order ? std::polar(w.amplitude_arcsec * units::arcsec, w.phase_rad) : 0.0;
  return sum;
}

/// Squared error of a coefficient in units of its covariance: chi-squared with 2 degrees of freedom.
inline double Pull2(const harmonics::Coefficient& c, harmonics::Complex truth) {
  const Eigen::Vector2d error(c.value.real() - truth.real(), c.value.imag() - truth.imag());
  return error.dot(c.cov.inverse() * error);
}

}  // namespace twinbench::test
