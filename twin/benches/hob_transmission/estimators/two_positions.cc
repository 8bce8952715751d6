#include "twin/benches/hob_transmission/estimators/two_positions.h"

#include <cmath>

#include "twin/core/errors.h"

namespace twinbench::separate::hob {
namespace {

/// Multiplication by f as a matrix on (real, imaginary).
Eigen::Matrix2d Times(Complex f) {
  Eigen::Matrix2d m;
  m << f.real(), -f.imag(), f.imag(), f.real();
  return m;
}

/// first x E_1 + second x E_2.
Coefficient Combine(Complex first, const Coefficient& e1, Complex second, const Coefficient& e2) {
  return {first * e1.value + second * e2.value,
          Times(first) * e1.cov * Times(first).transpose() + Times(second) * e2.cov * Times(second).transpose()};
}

/// A head that stands elsewhere by d changes its E by -j Psi exp(-j alpha) d.
Coefficient WithHeadUncertainty(const Coefficient& e, Complex psi, double head_rad, double u_head_rad) {
  const Complex d = u_head_rad * Complex(0.0, -1.0) * psi * std::polar(1.0, -head_rad);
  const Eigen::Vector2d parts(d.real(), d.imag());
  return {e.value, e.cov + parts * parts.transpose()};
}

}  // namespace

TwoPositions SeparateTwoPositions(const PositionError& first, const PositionError& second, double u_head_rad,
                                  const SeparationLimits& limits) {
  Require(first.status == PositionStatus::kOk && second.status == PositionStatus::kOk,
          "both positions must be there");
  Require(first.direction == second.direction, "both positions must be of one direction");
  TwoPositions result;
  result.noise_factor = NoiseFactor(1, {first.head_rad, second.head_rad});
  if (result.noise_factor > limits.max_noise_factor) return result;
  const Complex turn_1 = std::polar(1.0, -first.head_rad);
  const Complex turn_2 = std::polar(1.0, -second.head_rad);
  const Complex d = turn_1 - turn_2;
  const Complex psi = (first.series.At(1).value - second.series.At(1).value) / d;
  const Coefficient e1 = WithHeadUncertainty(first.series.At(1), psi, first.head_rad, u_head_rad);
  const Coefficient e2 = WithHeadUncertainty(second.series.At(1), psi, second.head_rad, u_head_rad);
  result.encoder = Combine(1.0 / d, e1, -1.0 / d, e2);
  result.transmission = Combine(-turn_2 / d, e1, turn_1 / d, e2);  // E_1 - Psi exp(-j alpha_1)
  result.status = Judge(result.noise_factor, LargestUncertainty(result.transmission), limits);
  result.corrected = first.series;
  result.corrected.At(1) = result.transmission;
  return result;
}

}  // namespace twinbench::separate::hob
