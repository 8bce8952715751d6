#include "twin/benches/encoder_comparison/diagnosis/signal_guess.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "twin/benches/encoder_comparison/diagnosis/families.h"
#include "twin/core/linear_algebra.h"
#include "twin/core/units.h"
#include "twin/model/signals.h"

namespace twinbench::diagnose::encoder {
namespace {

/// Offset of sine and cosine, ratio, quadrature [rad], level, zero [rad of the period], delay in `unit_s`.
using Faults = Eigen::Matrix<double, 7, 1>;
constexpr Eigen::Index kLevelAt = 4, kZeroAt = 5, kDelayAt = 6;

/// The readings over the period of the signals; everything in rad of it.
class Period {
 public:
  Period(const SignalContext& c, const Eigen::VectorXd& error_rad) {
    constexpr Eigen::Index kEnough = 1500;  // readings: a guess needs no more
    const Eigen::Index every = 1 + (c.Readings() - 1) / kEnough, count = 1 + (c.Readings() - 1) / every;
    const auto thinned = Eigen::seqN(0, count, every);
    const double periods = c.device.signal_periods;
    phase_ = SignalPhase_rad(c)(thinned);
    way_ = periods * c.velocity_rad_s(thinned);
    const double fastest = way_.cwiseAbs().maxCoeff();
    unit_s_ = fastest > 0.0 ? 0.1 / fastest : 0.0;
    std::vector<int> setup;
    for (Eigen::Index i = 0; i < count; ++i) setup.push_back(c.setup[static_cast<std::size_t>(i * every)]);
    Eigen::MatrixXd free = model::Indicators(setup);
    for (int order = 1; order <= 2 && c.device.signal_periods > 1; ++order) {
      const Eigen::VectorXd angle_rad = order * c.device_rad(thinned);
      free.conservativeResize(Eigen::NoChange, free.cols() + 2);
      free.rightCols(2) = model::Wave(angle_rad);
    }
    free_ = OrthonormalColumnsOf(free);
    error_ = Projected(periods * error_rad(thinned));
  }

  double DelayUnit_s() const { return unit_s_; }
  bool Moves() const { return unit_s_ > 0.0; }

  Eigen::VectorXd Left(const Faults& at) const {
    return error_ - Projected(OfSignals(at) - unit_s_ * at[kDelayAt] * way_);
  }
  double MeanError(const Faults& at) const { return OfSignals(at).mean(); }

  /// Of free waves of the first four orders and a delay, by which the waves are late as well.
  double LeftByWaves() const {
    constexpr int kSteps = 5;
    double later = 0.0, left = error_.squaredNorm();
    for (int step = 0; step < kSteps; ++step) {
      const Eigen::VectorXd phase = phase_ - later * way_;
      Eigen::MatrixXd columns(phase.size(), 9);
      for (int order = 1; order <= 4; ++order) columns.middleCols(2 * order - 2, 2) = model::Wave(order * phase);
      columns.col(8) = way_;
      columns -= free_ * (free_.transpose() * columns);
      const Eigen::VectorXd sizes = SolveShortest(columns, error_);
      left = std::min(left, (error_ - columns * sizes).squaredNorm());
      later = -sizes[8];
    }
    return left;
  }

 private:
  Eigen::VectorXd OfSignals(const Faults& at) const {
    const Eigen::VectorXd phase = (phase_ - unit_s_ * at[kDelayAt] * way_).array() - at[kZeroAt];
    return SignalError_rad(phase, {at[0], at[1], at[2], at[3], at[kLevelAt]});
  }
  Eigen::VectorXd Projected(const Eigen::VectorXd& rows) const { return rows - free_ * (free_.transpose() * rows); }

  Eigen::VectorXd phase_, way_, error_;  // way: what a second of delay is
  Eigen::MatrixXd free_;
  double unit_s_ = 0.0;
};

/// Within what can still be told from nothing and from chaos.
Faults Inside(Faults at) {
  constexpr double kMostFault = 0.6;
  at.head<4>() = at.head<4>().cwiseMax(-kMostFault).cwiseMin(kMostFault);
  at[kLevelAt] = std::clamp(at[kLevelAt], 0.3, 0.9999);
  return at;
}

Eigen::MatrixXd SlopesAt(const Period& period, const Faults& at, const std::vector<Eigen::Index>& free) {
  constexpr double kStep = 1e-3;
  Eigen::MatrixXd slopes(period.Left(at).size(), std::ssize(free));
  for (std::size_t k = 0; k < free.size(); ++k) {
    const Faults step = kStep * Faults::Unit(free[k]);
    slopes.col(static_cast<Eigen::Index>(k)) = (period.Left(at - step) - period.Left(at + step)) / (2.0 * kStep);
  }
  return slopes;
}

/// A guess and what it leaves.
struct Start {
  Faults at;
  double left;
};

/// Some steps of Gauss and Newton, halved until they help.
Start Improved(const Period& period, const Faults& start, const std::vector<Eigen::Index>& free) {
  constexpr int kSteps = 6, kHalvings = 4;
  Start best{start, period.Left(start).squaredNorm()};
  for (int step = 0; step < kSteps; ++step) {
    const Eigen::VectorXd by = SolveShortest(SlopesAt(period, best.at, free), period.Left(best.at));
    Faults way = Faults::Zero();
    for (std::size_t k = 0; k < free.size(); ++k) way[free[k]] = by[static_cast<Eigen::Index>(k)];
    Start next{best.at, best.left};
    for (int half = 0; half < kHalvings && !(next.left < best.left); ++half, way *= 0.5) {
      next.at = Inside(best.at + way);
      next.left = period.Left(next.at).squaredNorm();
    }
    if (!(next.left < best.left)) break;
    best = next;
  }
  return best;
}

Start BestOf(const Period& period, bool zero_known) {
  constexpr int kZeros = 6;  // in the quarter period after which all is the same
  std::vector<Eigen::Index> free = {0, 1, 2, 3, kLevelAt, kZeroAt};
  if (period.Moves()) free.push_back(kDelayAt);
  Start best{Faults::Zero(), std::numeric_limits<double>::infinity()};
  for (const double level : {0.35, 0.5, 0.65, 0.8, 0.92}) {
    for (int k = 0; k < (zero_known ? 1 : kZeros); ++k) {
      Faults start = Faults::Zero();
      start[kLevelAt] = level;
      start[kZeroAt] = 0.5 * units::kPi * k / kZeros;
      const Start guess = Improved(period, start, free);
      if (guess.left < best.left) best = guess;
    }
  }
  return best;
}

/// The same signals with the zero next to the one that was stated. A quarter period on, what was the cosine is the
/// sine, and what was the sine is the cosine with the other sign; levels and offsets count in amplitudes of the
/// cosine.
Faults NextToZero(Faults at) {
  constexpr double kQuarter = 0.5 * units::kPi;
  const auto turns = static_cast<int>(std::lround(at[kZeroAt] / kQuarter));
  const double sign = turns > 0 ? 1.0 : -1.0;
  for (int k = 0; k < std::abs(turns); ++k) {
    const double sine = 1.0 + at[2], offset_sin = at[0];
    at[0] = sign * at[1] / sine;
    at[1] = -sign * offset_sin / sine;
    at[2] = 1.0 / sine - 1.0;
    at[3] = -at[3];
    at[kLevelAt] /= sine;
    at[kZeroAt] -= sign * kQuarter;
  }
  return at;
}

bool ShowsThePeriod(const SignalContext& c) {
  constexpr int kSecondOrder = 8;  // of clipping
  return LeastOrder(c) <= c.device.signal_periods && LargestOrder(c) >= kSecondOrder * c.device.signal_periods;
}

}  // namespace

std::optional<SignalGuess> GuessSignals(const SignalContext& context, const Eigen::VectorXd& error_rad) {
  if (!ShowsThePeriod(context)) return std::nullopt;
  constexpr double kClearly = 0.5;  // of what free waves leave: orders 8 and 12 are there as clipping has them
  const Period period(context, error_rad);
  Start best = BestOf(period, context.device.signal_zero_known);
  if (!(best.left < kClearly * period.LeftByWaves())) return std::nullopt;
  // The angle of the device was taken from readings whose errors do not vanish in the mean.
  best.at[kZeroAt] -= period.MeanError(best.at);
  const Faults at = context.device.signal_zero_known ? best.at : NextToZero(best.at);
  return SignalGuess{{at[0], at[1], at[2], at[3], at[kLevelAt]},
                     at[kZeroAt] / context.device.signal_periods,
                     period.DelayUnit_s() * at[kDelayAt]};
}

}  // namespace twinbench::diagnose::encoder
