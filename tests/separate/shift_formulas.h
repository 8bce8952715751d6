#pragma once

#include <Eigen/Dense>
#include <cmath>
#include <complex>

#include "twin/core/units.h"

/// What theory says of the noise of shift separations.
namespace twinbench::separate {

/// Formula (V) of docs/theory.md 2: variance of the k-th Fourier coefficient for readings of variance 1.
template <class Shifts>
double ShiftVariance(int n, const Shifts& shifts, int k) {
  std::complex<double> a = 0.0;
  for (const auto s : shifts) a += std::polar(1.0, units::turn * k * s / n);
  const auto p = static_cast<double>(shifts.size());
  return p / (p * p - std::norm(a)) / n;
}

/// Variance of the k-th Fourier coefficient (1/n) sum x_i e^{-2 pi j k i / n} of values with this covariance.
inline double HarmonicVariance(const Eigen::MatrixXd& cov, int k) {
  const auto n = static_cast<int>(cov.rows());
  Eigen::VectorXcd f(n);
  for (int i = 0; i < n; ++i) f[i] = std::polar(1.0 / n, units::turn * k * i / n);
  return (f.adjoint() * cov.cast<std::complex<double>>() * f)(0, 0).real();
}

/// Root of the mean variance of the values, for readings of this standard deviation.
inline double RootMeanGain(const Eigen::MatrixXd& cov, double sigma) {
  return std::sqrt(cov.trace() / static_cast<double>(cov.rows())) / sigma;
}

}  // namespace twinbench::separate
