#include "twin/diagnose/engine/overtones.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <functional>
#include <utility>
#include <vector>

#include "twin/core/linear_algebra.h"
#include "twin/core/units.h"
#include "twin/diagnose/engine/base.h"
#include "twin/diagnose/engine/prior.h"
#include "twin/diagnose/tuning.h"

namespace twinbench::diagnose {
namespace {

constexpr int kHighest = 5;

bool IsNamedWave(const Family& family) {
  return family.kind == Kind::kNamed && family.at && family.shapes.size() == 1 &&
         family.shapes.front().name == "frequency";
}

/// Rows x columns of the wave at 2, 3, ... times its frequency.
Eigen::MatrixXd Overtones(const Family& family, const Eigen::VectorXd& frequency) {
  Eigen::MatrixXd all = family.at(2.0 * frequency);
  for (int n = 3; n <= kHighest; ++n) all = HStack(all, family.at(n * frequency));
  return all;
}

/// Overtones 2, 3, ... of a cosine of size 1 that begins at its crest, as cosine + i sine.
using Waveform = std::array<std::complex<double>, kHighest - 1>;

/// On for a share of the time, its middle at the crest.
Waveform Rectangle(double duty) {
  Waveform rectangle;
  for (int n = 2; n <= kHighest; ++n)
    rectangle[static_cast<std::size_t>(n - 2)] = std::sin(n * units::kPi * duty) / (n * std::sin(units::kPi * duty));
  return rectangle;
}

/// Slow one way and back at once: sin(t) + sin(2 t) / 2 + ..., whose fundamental has its crest a quarter of a turn on.
/// @param way  1 or -1.
Waveform SawTooth(double way) {
  Waveform saw;
  for (int n = 2; n <= kHighest; ++n) {
    const double turned = 0.5 * units::kPi * (n - 1);
    saw[static_cast<std::size_t>(n - 2)] = std::polar(1.0 / n, way * turned);
  }
  return saw;
}

std::vector<Waveform> LockedWaveforms() {
  std::vector<Waveform> waveforms = {SawTooth(1.0), SawTooth(-1.0)};
  for (int tenths = 1; tenths <= 9; ++tenths) waveforms.push_back(Rectangle(0.1 * tenths));
  return waveforms;
}

/// Coefficients of the overtones that a waveform has beside its fundamental.
/// @param fundamental  Cosine and sine of each stretch.
Eigen::VectorXd Following(const Waveform& waveform, const Eigen::VectorXd& fundamental) {
  Eigen::VectorXd overtones(fundamental.size() * std::ssize(waveform));
  for (std::size_t n = 0; n < waveform.size(); ++n) {
    for (Eigen::Index k = 0; k < fundamental.size(); k += 2) {
      const std::complex<double> crest(fundamental[k], fundamental[k + 1]);
      const std::complex<double> overtone =
          std::abs(crest) * waveform[n] * std::polar(1.0, (static_cast<double>(n) + 2.0) * std::arg(crest));
      overtones.segment<2>(static_cast<Eigen::Index>(n) * fundamental.size() + k) << overtone.real(), overtone.imag();
    }
  }
  return overtones;
}

/// Log Bayes factor of "mean + spread * N(0, 1)" in white data against nothing.
double LogBayesFactor(const Eigen::VectorXd& data, const Eigen::VectorXd& mean, const Eigen::MatrixXd& spread) {
  const Eigen::VectorXd off = data - mean, along = spread.transpose() * off;
  const Eigen::MatrixXd inner = Eigen::MatrixXd::Identity(spread.cols(), spread.cols()) + spread.transpose() * spread;
  const double chi2 = off.squaredNorm() - along.dot(SolvePositive(inner, along));
  return 0.5 * (data.squaredNorm() - chi2) - CholeskyFactorOf(inner).diagonal().array().log().sum();
}

/// One wave, what the readings leave beside all terms, and how overtones would show there: all white, in units of the
/// noise.
class Wave {
 public:
  /// @param shown  Whitens signatures and takes out what terms and free unknowns have of them.
  Wave(const Family& family, const Term& term, Eigen::VectorXd left,
       const std::function<Eigen::MatrixXd(const Eigen::MatrixXd&)>& shown)
      : amplitudes_(term.amplitudes),
        root_(CovarianceRootOf(term.cov)),
        steps_((0.1 * term.cov.diagonal().cwiseSqrt()).cwiseMax(1e-300)),
        left_(std::move(left)),
        overtones_(shown(Overtones(family, term.shape))),
        overtones_beside_(shown(Overtones(family, term.shape.array() + steps_[amplitudes_.size()]))) {}

  /// As the fundamental says, give or take what is not known of it.
  double LogBayesFactorLocked(const Waveform& waveform) const {
    const Eigen::VectorXd mean = overtones_ * Following(waveform, amplitudes_);
    return LogBayesFactor(left_, mean, SlopesOf(waveform, mean) * root_);
  }

  /// Of any phase. @param strength  Of the fundamental's size.
  double LogBayesFactorFree(double strength) const {
    const double stretches = 0.5 * static_cast<double>(amplitudes_.size());
    const double size = strength * amplitudes_.norm() / std::sqrt(2.0 * stretches);  // half of it each way
    return LogBayesFactor(left_, Eigen::VectorXd::Zero(left_.size()), size * overtones_);
  }

 private:
  /// Of what is shown, by cosines, sines and frequency of the fundamental: rows x amplitudes and one.
  Eigen::MatrixXd SlopesOf(const Waveform& waveform, const Eigen::VectorXd& mean) const {
    Eigen::MatrixXd slopes(mean.size(), steps_.size());
    const Eigen::Index sizes = amplitudes_.size();
    for (Eigen::Index k = 0; k < sizes; ++k) {
      const Eigen::VectorXd moved = amplitudes_ + steps_[k] * Eigen::VectorXd::Unit(sizes, k);
      slopes.col(k) = (overtones_ * Following(waveform, moved) - mean) / steps_[k];
    }
    slopes.col(sizes) = (overtones_beside_ * Following(waveform, amplitudes_) - mean) / steps_[sizes];
    return slopes;
  }

  Eigen::VectorXd amplitudes_;
  Eigen::MatrixXd root_;   // of the covariance of amplitudes and frequency
  Eigen::VectorXd steps_;  // of the same, for slopes
  Eigen::VectorXd left_;
  Eigen::MatrixXd overtones_, overtones_beside_;  // the latter at the frequency's step
};

/// Log of the mean of their exponentials.
double LogMean(const std::vector<double>& logs) {
  return LogSum(Eigen::Map<const Eigen::VectorXd>(logs.data(), std::ssize(logs))) - std::log(logs.size());
}

double LogBayesFactor(const Wave& wave) {
  std::vector<double> locked, free;
  for (const Waveform& waveform : LockedWaveforms()) locked.push_back(wave.LogBayesFactorLocked(waveform));
  for (const double strength : {1.0 / 6.0, 1.0 / 3.0, 2.0 / 3.0}) free.push_back(wave.LogBayesFactorFree(strength));
  return LogMean({LogMean(locked), LogMean(free)});
}

}  // namespace

bool HasNamedWave(const std::vector<Family>& families, const std::vector<Term>& terms) {
  return std::ranges::any_of(terms, [&](const Term& t) { return IsNamedWave(families[static_cast<std::size_t>(t.family)]); });
}

double ProbabilityOfOvertones(const LinearRun& run, const NoiseModel& noise, const Projector& projector,
                              const std::vector<Family>& families, const Eigen::MatrixXd& white,
                              const std::vector<Term>& terms, const Eigen::MatrixXd& columns) {
  const Deflation others(projector, columns);
  const Projected left = Project(projector, others, white);
  const double degrees = projector.DegreesOfFreedom() - static_cast<double>(others.Rank());
  const double noise_left = std::sqrt(std::max(1.0, left.power[0] / degrees));
  const auto shown = [&](const Eigen::MatrixXd& signatures) {
    return Eigen::MatrixXd(others.Apply(projector.Apply(noise.Whiten(run, signatures))) / noise_left);
  };
  double most = 0.0;
  for (const Term& term : terms) {
    const Family& family = families[static_cast<std::size_t>(term.family)];
    if (!IsNamedWave(family)) continue;
    const Wave wave(family, term, left.rows.col(0) / noise_left, shown);
    most = std::max(most, 1.0 / (1.0 + std::exp(-LogBayesFactor(wave)) / tuning::kNoSine));
  }
  return most;
}

}  // namespace twinbench::diagnose
