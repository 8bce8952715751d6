#include "twin/separate/series.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>

#include "twin/core/linear_algebra.h"
#include "twin/core/units.h"

namespace twinbench::separate::harmonics {
namespace {

Eigen::Vector2d Parts(Complex c) {
  return {c.real(), c.imag()};
}

double UncertaintyAlong(const Coefficient& c, const Eigen::Vector2d& unit) {
  return std::sqrt(unit.dot(c.cov * unit));
}

/// Derivative of the value at th by real and imaginary part of the coefficient.
Eigen::Vector2d Sensitivity(int order, double th_rad) {
  return {std::cos(order * th_rad), -std::sin(order * th_rad)};
}

bool Known(const Coefficient& c) {
  return std::isfinite(c.value.real()) && std::isfinite(c.value.imag());
}

/// Sum over the known orders of `term(coefficient, sensitivity)` at each point of the grid.
template <class Term>
Eigen::VectorXd SumOnGrid(const HarmonicSeries& series, int points, Term term) {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(points);
  for (int k = 1; k <= series.Highest(); ++k) {
    if (!Known(series.At(k))) continue;
    for (int i = 0; i < points; ++i) sum[i] += term(series.At(k), Sensitivity(k, 2.0 * units::kPi * i / points));
  }
  return sum;
}

}  // namespace

double Amplitude(const Coefficient& c) {
  return std::abs(c.value);
}

double Phase(const Coefficient& c) {
  return std::arg(c.value);
}

double AmplitudeUncertainty(const Coefficient& c) {
  return UncertaintyAlong(c, Parts(std::polar(1.0, Phase(c))));
}

double PhaseUncertainty(const Coefficient& c) {
  return UncertaintyAlong(c, Parts(std::polar(1.0, Phase(c) + 0.5 * units::kPi))) / Amplitude(c);
}

double LargestUncertainty(const Coefficient& c) {
  if (!c.cov.allFinite()) return kNaN;
  return std::sqrt(EigenvaluesOfSymmetric(c.cov)[1]);
}

Coefficient Shifted(const Coefficient& c, int order, double shift_rad) {
  const Eigen::Matrix2d turn = Eigen::Rotation2Dd(-order * shift_rad).toRotationMatrix();
  return {c.value * std::polar(1.0, -order * shift_rad), turn * c.cov * turn.transpose()};
}

double ValueAt(const HarmonicSeries& series, double th_rad) {
  double value_rad = 0.0;
  for (int k = 1; k <= series.Highest(); ++k) {
    const Complex c = series.At(k).value;
    if (std::isfinite(c.real())) value_rad += (c * std::polar(1.0, k * th_rad)).real();
  }
  return value_rad;
}

Eigen::VectorXd Resample(const HarmonicSeries& series, int points) {
  return SumOnGrid(series, points,
                   [](const Coefficient& c, const Eigen::Vector2d& d) { return d.dot(Parts(c.value)); });
}

Eigen::VectorXd ResampledUncertainty(const HarmonicSeries& series, int points) {
  const auto variance = [](const Coefficient& c, const Eigen::Vector2d& d) { return d.dot(c.cov * d); };
  return (SumOnGrid(series, points, variance).array() + series.unresolved_rad2).sqrt();
}

double ChanceOf(const Coefficient& c, double dof) {
  const double q = Parts(c.value).dot(c.cov.inverse() * Parts(c.value));
  return std::pow(1.0 + q / dof, -0.5 * dof);
}

std::vector<int> FindLines(const HarmonicSeries& series, double false_alarm) {
  std::vector<int> lines;
  for (int k = 1; k <= series.Highest(); ++k) {
    if (Known(series.At(k)) && ChanceOf(series.At(k), series.dof) < false_alarm / series.Highest())
      lines.push_back(k);
  }
  return lines;
}

}  // namespace twinbench::separate::harmonics
