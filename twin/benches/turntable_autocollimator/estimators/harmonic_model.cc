#include "twin/benches/turntable_autocollimator/estimators/harmonic_model.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <string>

#include "twin/core/errors.h"
#include "twin/core/linear_algebra.h"
#include "twin/core/units.h"
#include "twin/separate/fourier.h"

namespace twinbench::separate::turntable {
namespace {

constexpr int kMostOfUneven = 200;  // orders that are looked at; they cost n times their square

Eigen::MatrixXd BasisAt(const std::vector<double>& angles_rad, int highest_order) {
  Eigen::MatrixXd basis(std::ssize(angles_rad), 2 * highest_order + 1);
  for (std::size_t i = 0; i < angles_rad.size(); ++i)
    basis.row(static_cast<Eigen::Index>(i)) = HarmonicBasis(angles_rad[i], highest_order);
  return basis;
}

/// Covariance of the series, or that of independent noise of the size of the residuals if it is not known.
CurveCovariance CovarianceOf(const AngleSeries& series, double mean_square_rad2) {
  if (series.cov_rad2.diagonal().allFinite()) return series.cov_rad2;
  Eigen::VectorXd lags = Eigen::VectorXd::Zero(std::ssize(series.position_rad));
  lags[0] = mean_square_rad2;
  return CurveCovariance::Circulant(lags, 1);
}

/// Positions that divide the circle evenly.
bool IsEvenCircle(const std::vector<double>& angles_rad) {
  constexpr double kSame_rad = 1e-9;
  const double step_rad = units::turn / static_cast<double>(angles_rad.size());
  for (std::size_t i = 1; i < angles_rad.size(); ++i) {
    if (!(std::abs(angles_rad[i] - angles_rad[i - 1] - step_rad) < kSame_rad)) return false;
  }
  return true;
}

/// Square of what the orders 0 to k leave of a series, for each k from 0 to `highest_order`.
Eigen::VectorXd LeftByOrders(const AngleSeries& series, int highest_order) {
  const auto n = std::ssize(series.position_rad);
  Eigen::VectorXd left(highest_order + 1);
  if (!IsEvenCircle(series.position_rad)) {
    // Orders are nested: a model of order k leaves the part of Q^T value that lies behind its 2 k + 1 columns.
    const Eigen::VectorXd rotated_rad = RotatedByQ(BasisAt(series.position_rad, highest_order), series.value_rad);
    for (int k = 0; k <= highest_order; ++k) left[k] = rotated_rad.tail(n - 2 * k - 1).squaredNorm();
    return left;
  }
  const Eigen::VectorXcd wave = Fourier(static_cast<int>(n)).Forward(series.value_rad.cast<std::complex<double>>());
  double sum = 0.0;
  for (Eigen::Index k = n / 2; k >= 0; --k) {
    if (k <= highest_order) left[k] = sum;
    sum += (2 * k == n ? 1.0 : 2.0) * std::norm(wave[k]) / static_cast<double>(n);
  }
  return left;
}

/// Derivatives of each term's amplitude and, behind all of them, of its phase times amplitude by the series.
Eigen::MatrixXd Derivatives(const Eigen::VectorXd& coefficients_rad, const Eigen::MatrixXd& to_coefficients) {
  const Eigen::Index terms = coefficients_rad.size() / 2;
  Eigen::MatrixXd derivatives(to_coefficients.cols(), 2 * terms);
  for (Eigen::Index k = 0; k < terms; ++k) {
    const Eigen::Vector2d along = coefficients_rad.segment<2>(2 * k + 1).normalized(),
                          across(along.y(), -along.x());
    const auto by_series = to_coefficients.middleRows<2>(2 * k + 1).transpose();
    derivatives.col(k) = by_series * along;
    derivatives.col(terms + k) = by_series * across;
  }
  return derivatives;
}

SourceVariances SourcesOf(double variance, const SeriesSources& sources, const Eigen::VectorXd& derivative) {
  SourceVariances of;
  of.roll = std::pow(derivative.dot(sources.of_roll_rad), 2);
  if (sources.of_teeth_rad2) of.teeth = derivative.dot(sources.of_teeth_rad2->Times(derivative).col(0));
  of.readings = std::max(0.0, variance - of.roll - of.teeth);
  return of;
}

void AddSources(const SeriesSources& sources, const Eigen::MatrixXd& derivatives, HarmonicModel& model) {
  const Eigen::Index terms = std::ssize(model.terms);
  for (Eigen::Index k = 0; k < terms; ++k) {
    const HarmonicTerm& term = model.terms[static_cast<std::size_t>(k)];
    const double u_across_rad = term.u_phase_rad * term.amplitude_rad;
    model.of_amplitudes_rad2.push_back(
        SourcesOf(term.u_amplitude_rad * term.u_amplitude_rad, sources, derivatives.col(k)));
    model.of_phases_rad2.push_back(SourcesOf(u_across_rad * u_across_rad, sources, derivatives.col(terms + k)));
  }
}

}  // namespace

Eigen::RowVectorXd HarmonicBasis(double angle_rad, int highest_order) {
  Eigen::RowVectorXd basis(2 * highest_order + 1);
  basis[0] = 1.0;
  for (int k = 1; k <= highest_order; ++k) {
    basis[2 * k - 1] = std::cos(k * angle_rad);
    basis[2 * k] = std::sin(k * angle_rad);
  }
  return basis;
}

HarmonicTerm TermOf(int order, const Eigen::Vector2d& cs, const Eigen::Matrix2d& cov) {
  // a sin(k theta + alpha) with a = |(c, s)|, alpha = atan2(c, s)
  const double amplitude_rad = cs.norm();
  const Eigen::Vector2d along = cs / amplitude_rad, across(along.y(), -along.x());
  return {order, amplitude_rad, std::atan2(cs[0], cs[1]), std::sqrt(along.dot(cov * along)),
          std::sqrt(across.dot(cov * across)) / amplitude_rad};
}

int MostHarmonics(int positions) {
  return (positions - 1) / 2;
}

HarmonicModel FitHarmonics(const AngleSeries& series, int highest_order) {
  const auto n = static_cast<int>(series.position_rad.size());
  if (highest_order < 0 || highest_order > MostHarmonics(n)) {
    throw InputError("harmonic model", "highest order " + std::to_string(highest_order),
                     "0 to " + std::to_string(MostHarmonics(n)) + " for " + std::to_string(n) + " positions");
  }
  const Eigen::MatrixXd basis = BasisAt(series.position_rad, highest_order);
  const Eigen::MatrixXd to_coefficients = PseudoInverseOf(basis);
  HarmonicModel model;
  model.highest_order = highest_order;
  model.coefficients_rad = to_coefficients * series.value_rad;
  const Eigen::VectorXd rest_rad = series.value_rad - basis * model.coefficients_rad;
  const double left = std::max(1.0, static_cast<double>(n - basis.cols()));
  const double mean_square_rad2 = rest_rad.squaredNorm() / left;
  const CurveCovariance cov_rad2 = CovarianceOf(series, mean_square_rad2);
  const Eigen::MatrixXd across_rad2 = cov_rad2.Times(to_coefficients.transpose());
  model.cov_rad2 = to_coefficients * across_rad2;
  model.residual_rms_rad = std::sqrt(rest_rad.squaredNorm() / n);
  // Expected sum of squared residuals: trace of (1 - H) cov, with H = basis * to_coefficients.
  const double expected_rad2 = (cov_rad2.diagonal().sum() - basis.cwiseProduct(across_rad2).sum()) / left;
  model.u_unmodelled_rad = std::sqrt(std::max(0.0, mean_square_rad2 - expected_rad2));
  for (int k = 1; k <= highest_order; ++k)
    model.terms.push_back(
        TermOf(k, model.coefficients_rad.segment<2>(2 * k - 1), model.cov_rad2.block<2, 2>(2 * k - 1, 2 * k - 1)));
  if (series.sources) AddSources(*series.sources, Derivatives(model.coefficients_rad, to_coefficients), model);
  return model;
}

CurvePoint HarmonicModel::At(double turntable_rad) const {
  const Eigen::RowVectorXd basis = HarmonicBasis(turntable_rad, highest_order);
  const double variance_rad2 = basis * cov_rad2 * basis.transpose();
  return {basis.dot(coefficients_rad), std::sqrt(variance_rad2 + u_unmodelled_rad * u_unmodelled_rad)};
}

int ChooseHighestOrder(const AngleSeries& series) {
  const auto n = static_cast<int>(series.position_rad.size());
  const bool even = IsEvenCircle(series.position_rad);
  const int highest = even ? MostHarmonics(n) : std::min(MostHarmonics(n), kMostOfUneven);
  const Eigen::VectorXd left_rad2 = LeftByOrders(series, highest);
  int best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (int order = 0; order <= highest && 2 * order + 3 < n; ++order) {
    const double mean_square_rad2 = left_rad2[order] / n;
    const double parameters = 2.0 * order + 2.0;  // the noise is one of them
    const double aicc = n * std::log(mean_square_rad2) + 2.0 * parameters * n / (n - parameters - 1.0);
    if (!(aicc < least)) continue;
    least = aicc;
    best = order;
  }
  return best;
}

}  // namespace twinbench::separate::turntable
