#include <Eigen/LU>
#include <algorithm>
#include <bit>
#include <cmath>
#include <unsupported/Eigen/FFT>
#include <utility>

#include "twin/core/distributions.h"
#include "twin/core/units.h"
#include "twin/diagnose/screen/circumstances.h"
#include "twin/diagnose/screen/estimators.h"
#include "twin/diagnose/screen/scan.h"
#include "twin/diagnose/screen/tests.h"

namespace twinbench::diagnose::screen {
namespace {

constexpr int kGridReach = 6;  // grid points on either side of a reading: six digits

struct Grid {
  int size = 0;
  double width = 0.0;  // tau of the paper: the Gaussian is exp(-x^2 / (4 width))
};

Grid GridFor(int count) {
  const auto size = static_cast<int>(std::bit_ceil(static_cast<unsigned>(4 * count + 4 * kGridReach)));
  const double modes = 2.0 * count, oversampling = size / modes;
  return {size, units::kPi * kGridReach / (modes * modes * oversampling * (oversampling - 0.5))};
}

/// Share of each reading that the grid points around it get: grid x readings.
Eigen::SparseMatrix<double> Spreading(const Eigen::VectorXd& turns, const Grid& grid) {
  std::vector<Eigen::Triplet<double>> shares;
  for (int i = 0; i < turns.size(); ++i) {
    const double at = (turns[i] - std::floor(turns[i])) * grid.size;
    for (int point = static_cast<int>(at) - kGridReach + 1; point <= static_cast<int>(at) + kGridReach; ++point) {
      const double away_rad = (at - point) * (units::turn / grid.size);
      shares.emplace_back((point + grid.size) % grid.size, i, std::exp(-away_rad * away_rad / (4.0 * grid.width)));
    }
  }
  Eigen::SparseMatrix<double> spreading(grid.size, turns.size());
  spreading.setFromTriplets(shares.begin(), shares.end());
  return spreading;
}

/// Multiples of `step_Hz`, up to the Nyquist frequency of the median interval.
struct ToneGrid {
  double step_Hz = kNaN;
  int count = 0;
};

/// Steps of half a cycle over the run, wider ones in runs of more than kMostTones readings.
ToneGrid TonesOf(const Eigen::VectorXd& time_s) {
  constexpr double kMostTones = 16384.0;
  const Eigen::VectorXd interval_s = time_s.tail(time_s.size() - 1) - time_s.head(time_s.size() - 1);
  const double nyquist_Hz = 0.5 / Median({interval_s.begin(), interval_s.end()});
  const double wanted = std::ceil(2.0 * nyquist_Hz * (time_s.maxCoeff() - time_s.minCoeff()));
  const int count = static_cast<int>(std::clamp(wanted, 1.0, kMostTones));
  return {nyquist_Hz / count, count};
}

/// What cosine and sine at one frequency explain in each column, as chi-squared of two degrees of freedom.
///
/// Their covariance in noise is that of the nulls, a null's own share taken out again (a rank-one downdate), so
/// that run and nulls are judged alike. A direction that the free unknowns absorb counts with `floor` at least.
Eigen::RowVectorXd Explained(const Eigen::RowVectorXcd& tone, double floor) {
  const auto nulls = static_cast<double>(tone.size() - 1);
  Eigen::Matrix2Xd parts(2, tone.size());
  parts << tone.real(), tone.imag();
  const auto of_nulls = parts.rightCols(tone.size() - 1);
  const Eigen::Matrix2d cov = of_nulls * of_nulls.transpose() / nulls + floor * Eigen::Matrix2d::Identity();
  Eigen::RowVectorXd explained = parts.cwiseProduct(cov.inverse() * parts).colwise().sum();
  auto own = explained.tail(tone.size() - 1).array();
  own = (nulls - 1.0) / nulls * own / (1.0 - own / nulls).max(1e-3);
  return explained;
}

/// Adds what one channel explains to `explained`, tones x columns.
void AddChannel(const Sample& s, int channel, const ToneGrid& tones, Eigen::MatrixXd& explained) {
  constexpr double kSurvives = 1e-3;
  const Eigen::MatrixXcd spectrum = Spectrum(s.run.schedule.time_s, s.adjoint[channel], tones.step_Hz, tones.count);
  const double typical = 0.5 * spectrum.rightCols(s.Columns() - 1).cwiseAbs2().mean();
  if (!(typical > 0.0)) return;
  for (int k = 0; k < tones.count; ++k) explained.row(k) += Explained(spectrum.row(k), kSurvives * typical);
}

}  // namespace

Eigen::MatrixXcd Spectrum(const Eigen::VectorXd& time_s, const Eigen::MatrixXd& series, double step_Hz, int count) {
  const Grid grid = GridFor(count);
  const Eigen::SparseMatrix<double> spreading = Spreading(step_Hz * (time_s.array() - time_s[0]).matrix(), grid);
  const Eigen::ArrayXd order = Eigen::ArrayXd::LinSpaced(count, 1.0, count);
  const Eigen::ArrayXd undo = std::sqrt(units::kPi / grid.width) / grid.size * (order.square() * grid.width).exp();
  Eigen::FFT<double> fft(Eigen::FFT<double>::impl_type(), Eigen::FFT<double>::HalfSpectrum);
  Eigen::VectorXcd transform;
  Eigen::MatrixXcd spectrum(count, series.cols());
  for (Eigen::Index j = 0; j < series.cols(); ++j) {
    fft.fwd(transform, Eigen::VectorXd(spreading * series.col(j)));
    spectrum.col(j) = transform.segment(1, count).array() * undo;
  }
  return spectrum;
}

/// Cosine and sine in time on uneven times (Lomb 1976, Scargle 1982).
void TestTones(const Sample& s, Tests& tests) {
  const Eigen::VectorXd& time_s = s.run.schedule.time_s;
  if (time_s.size() < 8 || !Varies(time_s)) return;
  const ToneGrid tones = TonesOf(time_s);
  Statistic scores{"time: tone", {}, Eigen::MatrixXd::Zero(tones.count, s.Columns())};
  for (int c = 0; c < s.run.Channels(); ++c) AddChannel(s, c, tones, scores.values);
  scores.values = scores.values.unaryExpr([&](double chi2) { return NormalScore(chi2, 2 * s.run.Channels()); });
  for (int k = 1; k <= tones.count; ++k)
    scores.items.push_back(ItemOf(scores.test, 1e3 * (k * tones.step_Hz), 1.0 / (k * tones.step_Hz)));
  auto [test, item] = LoudestOf(scores);
  const double frequency_Hz = (item + 1) * tones.step_Hz;
  Scan tone{scores.test, 2};
  tone.Add(Wave(units::turn * frequency_Hz * (time_s.array() - time_s[0])), 1e3 * frequency_Hz, 1.0 / frequency_Hz);
  Describe(s, FitItem(s, tone, 0), true, scores.items[item], test);
  tests.push_back(std::move(test));
}

}  // namespace twinbench::diagnose::screen
