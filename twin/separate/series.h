#pragma once

#include <Eigen/Core>
#include <complex>
#include <vector>

#include "twin/core/reading.h"

namespace twinbench::separate::harmonics {

using Complex = std::complex<double>;

/// One order of a periodic function: C = a - j b of a cos(k th) + b sin(k th) [rad].
struct Coefficient {
  Complex value = {kNaN, kNaN};
  Eigen::Matrix2d cov = Eigen::Matrix2d::Constant(kNaN);  // of real and imaginary part [rad^2]
};

double Amplitude(const Coefficient& c);
double Phase(const Coefficient& c);  // of the cosine, (-pi, pi]
/// First order: right while the amplitude is several times its uncertainty.
double AmplitudeUncertainty(const Coefficient& c);
double PhaseUncertainty(const Coefficient& c);
/// Largest standard uncertainty of the part of C in any phase.
double LargestUncertainty(const Coefficient& c);

/// The coefficient of x(th - shift): C exp(-j k shift), covariance turned with it.
Coefficient Shifted(const Coefficient& c, int order, double shift_rad);

/// Orders 1 .. size() of a periodic function without its mean. Orders are taken as independent of each other.
struct HarmonicSeries {
  std::vector<Coefficient> orders = {};
  double dof = kNaN;  // degrees of freedom behind the covariances
  double unresolved_rad2 = 0.0;  // variance at any angle of orders above the highest, which are not in `orders`

  int Highest() const { return static_cast<int>(orders.size()); }
  const Coefficient& At(int order) const { return orders.at(static_cast<std::size_t>(order - 1)); }
  Coefficient& At(int order) { return orders.at(static_cast<std::size_t>(order - 1)); }
};

/// Re sum C_k exp(j k th) over the orders that are known.
double ValueAt(const HarmonicSeries& series, double th_rad);

/// Values at th = 2 pi i / points, i = 0 .. points - 1 [rad], and their standard uncertainties. Orders that are NaN
/// are left out.
Eigen::VectorXd Resample(const HarmonicSeries& series, int points);
Eigen::VectorXd ResampledUncertainty(const HarmonicSeries& series, int points);

/// Probability that noise alone has an amplitude as large as this one's: with q = C^T cov^-1 C and `dof` degrees of
/// freedom behind cov, (1 + q / dof)^(-dof / 2), which is F(2, dof) in closed form.
double ChanceOf(const Coefficient& c, double dof);

/// Orders that noise alone would show in one of 1 / false_alarm spectra, all orders of the series together.
std::vector<int> FindLines(const HarmonicSeries& series, double false_alarm = 0.01);

}  // namespace twinbench::separate::harmonics
