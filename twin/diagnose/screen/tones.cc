#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "twin/diagnose/screen/circumstances.h"
#include "twin/diagnose/screen/spectrum.h"
#include "twin/diagnose/screen/tests.h"
#include "twin/diagnose/screen/words.h"

namespace twinbench::diagnose::screen {
namespace {

constexpr int kMostTones = 16384;

/// Multiples of `step_Hz`, up to the Nyquist frequency of the median interval.
struct ToneGrid {
  double step_Hz = kNaN;
  int count = 0;
};

/// Steps of half a cycle over the run, wider ones in runs of more than kMostTones readings.
ToneGrid TonesOf(const Eigen::VectorXd& time_s) {
  std::vector<double> interval_s;
  for (Eigen::Index i = 1; i < time_s.size(); ++i) interval_s.push_back(time_s[i] - time_s[i - 1]);
  std::nth_element(interval_s.begin(), interval_s.begin() + std::ssize(interval_s) / 2, interval_s.end());
  const double nyquist_Hz = 0.5 / interval_s[interval_s.size() / 2];
  const double duration_s = time_s.maxCoeff() - time_s.minCoeff();
  const double wanted = std::ceil(2.0 * nyquist_Hz * duration_s);
  const int count = static_cast<int>(std::clamp(wanted, 1.0, static_cast<double>(kMostTones)));
  return {nyquist_Hz / count, count};
}

/// What cosine and sine at one frequency explain in each column, as chi-squared of two degrees of freedom.
///
/// Their covariance in noise is that of the nulls, a null's own share taken out again (a rank-one downdate), so
/// that run and nulls are judged alike. A direction that the free unknowns absorb counts with `floor` at least.
Eigen::RowVectorXd Explained(const Eigen::RowVectorXcd& tone, double floor) {
  const Eigen::Index nulls = tone.size() - 1;
  Eigen::Matrix2Xd parts(2, tone.size());
  parts << tone.real(), tone.imag();
  const Eigen::Matrix2d cov =
      parts.rightCols(nulls) * parts.rightCols(nulls).transpose() / static_cast<double>(nulls) +
      floor * Eigen::Matrix2d::Identity();
  Eigen::RowVectorXd explained = parts.cwiseProduct(cov.inverse() * parts).colwise().sum();
  const auto n = static_cast<double>(nulls);
  auto own = explained.tail(nulls).array();
  own = (n - 1.0) / n * own / (1.0 - own / n).max(1e-3);
  return explained;
}

/// Adds what one channel explains to `explained`, tones x columns.
void AddChannel(const Sample& s, int channel, const ToneGrid& tones, Eigen::MatrixXd& explained) {
  constexpr double kSurvives = 1e-3;
  const Eigen::MatrixXcd spectrum =
      Spectrum(s.run.schedule.time_s, s.adjoint[static_cast<std::size_t>(channel)], tones.step_Hz, tones.count);
  const double typical = 0.5 * spectrum.rightCols(s.Columns() - 1).cwiseAbs2().mean();
  if (!(typical > 0.0)) return;
  for (Eigen::Index k = 0; k < tones.count; ++k)
    explained.row(k) += Explained(spectrum.row(k), kSurvives * typical);
}

std::string ToneWords(double frequency_Hz) {
  return fmt::format("a tone of {:.3g} mHz (period {:.4g} s)", 1e3 * frequency_Hz, 1.0 / frequency_Hz);
}

Scan OneTone(const Eigen::VectorXd& time_s, double frequency_Hz) {
  const Eigen::ArrayXd phase = 2.0 * std::numbers::pi * frequency_Hz * (time_s.array() - time_s[0]);
  Eigen::MatrixXd shapes(time_s.size(), 2);
  shapes << phase.cos(), phase.sin();
  return {{std::move(shapes)}, 2};
}

}  // namespace

/// Cosine and sine in time on uneven times (Lomb 1976, Scargle 1982).
Tests TestTones(const Sample& sample) {
  const Eigen::VectorXd& time_s = sample.run.schedule.time_s;
  if (time_s.size() < 8 || !Varies(time_s)) return {};
  const ToneGrid tones = TonesOf(time_s);
  Eigen::MatrixXd scores = Eigen::MatrixXd::Zero(tones.count, sample.Columns());
  for (int c = 0; c < sample.run.Channels(); ++c) AddChannel(sample, c, tones, scores);
  scores = scores.unaryExpr([&](double chi2) { return NormalScore(chi2, 2 * sample.run.Channels()); });
  ScanWords words{"time: tone", {}, "hum or vibration aliased by the stops, an air conditioner's cycle"};
  for (int k = 1; k <= tones.count; ++k) words.items.push_back(ToneWords(k * tones.step_Hz));
  const auto fit = [&](int item) { return FitItem(sample, OneTone(time_s, (item + 1) * tones.step_Hz), 0); };
  Tests tests;
  Keep(FromScores(sample, scores, fit, words), tests);
  return tests;
}

}  // namespace twinbench::diagnose::screen
