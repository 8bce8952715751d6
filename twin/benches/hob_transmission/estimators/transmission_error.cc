#include "twin/benches/hob_transmission/estimators/transmission_error.h"

#include <algorithm>
#include <cmath>

#include "twin/benches/hob_transmission/estimators/hob_orders.h"
#include "twin/benches/hob_transmission/estimators/rounding_orders.h"
#include "twin/benches/hob_transmission/estimators/turn_fit.h"
#include "twin/benches/hob_transmission/estimators/turns.h"
#include "twin/core/errors.h"
#include "twin/core/rounding.h"

namespace twinbench::separate::hob {
namespace {

struct FittedTurn {
  int index = 0;
  TurnFit fit;
};

/// Slope of the turn means of one pass over the number of the turn; zero unless known.
struct Drift {
  double rad_per_turn = 0.0;
  double variance = 0.0;
  bool known = false;
};

struct FittedPass {
  std::vector<FittedTurn> turns;
  int left_out = 0;  // not determined, or inflated beyond the limit
  Drift drift;
};

/// Each run of turns without a gap has a constant of its own: counts may have been lost in the gap.
Drift FitDrift(const std::vector<FittedTurn>& turns) {
  const auto n = std::ssize(turns);
  Eigen::ArrayXd x(n), y(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    x[i] = turns[static_cast<std::size_t>(i)].index;
    y[i] = turns[static_cast<std::size_t>(i)].fit.mean_rad;
  }
  Eigen::Index dof = n - 1;
  for (Eigen::Index first = 0, end = 0; first < n; first = end, --dof) {
    for (end = first + 1; end < n && x[end] - x[end - 1] < 1.5;) ++end;
    x.segment(first, end - first) -= x.segment(first, end - first).mean();
    y.segment(first, end - first) -= y.segment(first, end - first).mean();
  }
  if (dof < 1) return {};  // a line through two means leaves nothing to judge it by
  const double slope = (x * y).sum() / x.square().sum();
  const double residual2 = (y - slope * x).square().sum() / static_cast<double>(dof);
  return {slope, residual2 / x.square().sum(), true};
}

/// Fits the turns of one pass, and a steady drift if there are three of them.
FittedPass FitPass(const Pass& pass, const TransmissionOptions& options) {
  FittedPass fitted;
  for (const Turn& turn : CutIntoTurns(pass)) {
    TurnFit fit = FitTurn(turn.th_rad, turn.value_rad, turn.middle_rad, pass.direction, options.max_order);
    if (fit.determined && fit.inflation < options.max_inflation) {
      fitted.turns.push_back({turn.index, std::move(fit)});
    } else {
      ++fitted.left_out;
    }
  }
  fitted.drift = FitDrift(fitted.turns);
  return fitted;
}

Complex WithoutDrift(const FittedTurn& turn, const Drift& drift, Eigen::Index k) {
  return turn.fit.value[k] - drift.rad_per_turn * turn.fit.ramp[k];
}

/// All turns of one set-up and direction, drift taken out. Rows: turns; columns: orders 1 ..
Eigen::MatrixXcd Stack(const std::vector<FittedPass>& passes, int turns, int max_order) {
  Eigen::MatrixXcd stack(turns, max_order);
  Eigen::Index row = 0;
  for (const FittedPass& pass : passes) {
    for (const FittedTurn& turn : pass.turns) {
      for (Eigen::Index k = 0; k < max_order; ++k) stack(row, k) = WithoutDrift(turn, pass.drift, k);
      ++row;
    }
  }
  return stack;
}

/// Variance of one part of each order's mean over the turns, from their scatter pooled with neighbouring orders.
Eigen::VectorXd ScatterVariance(const Eigen::MatrixXcd& stack, int pooled_orders) {
  const Eigen::MatrixXcd rest = stack.rowwise() - stack.colwise().mean();
  const auto turns = static_cast<double>(stack.rows());
  const Eigen::VectorXd single = rest.cwiseAbs2().colwise().sum().transpose() / (2.0 * (turns - 1.0));
  Eigen::VectorXd pooled(single.size());
  for (Eigen::Index k = 0; k < single.size(); ++k) {
    const Eigen::Index first = std::max<Eigen::Index>(0, k - pooled_orders);
    const Eigen::Index last = std::min<Eigen::Index>(single.size() - 1, k + pooled_orders);
    pooled[k] = single.segment(first, last - first + 1).mean() / turns;
  }
  return pooled;
}

/// The error of a pass's drift is common to its turns: what it leaves in the mean of order k + 1.
Eigen::Matrix2d DriftCovariance(const std::vector<FittedPass>& passes, int turns, Eigen::Index k) {
  Eigen::Matrix2d cov = Eigen::Matrix2d::Zero();
  for (const FittedPass& pass : passes) {
    Complex left = 0.0;
    for (const FittedTurn& turn : pass.turns) left += turn.fit.ramp[k] / static_cast<double>(turns);
    const Eigen::Vector2d parts(left.real(), left.imag());
    cov += pass.drift.variance * parts * parts.transpose();
  }
  return cov;
}

void FillFromSeveralTurns(const std::vector<FittedPass>& passes, const TransmissionOptions& options,
                          PositionError& position) {
  const Eigen::MatrixXcd stack = Stack(passes, position.turns, options.max_order);
  const Eigen::VectorXd variance = ScatterVariance(stack, options.pooled_orders);
  for (Eigen::Index k = 0; k < stack.cols(); ++k) {
    const Eigen::Matrix2d of_drift = DriftCovariance(passes, position.turns, k);
    const Eigen::Matrix2d cov = variance[k] * Eigen::Matrix2d::Identity() + of_drift;
    position.series.orders.push_back({stack.col(k).mean(), cov});
    position.of_drift_rad2.push_back(0.5 * of_drift.trace());
  }
  const int pooled = std::min(options.pooled_orders + 1, options.max_order);  // at either end of the spectrum
  position.series.dof = 2.0 * (position.turns - 1) * pooled;
}

void FillFromOneTurn(const TurnFit& fit, PositionError& position) {
  position.scatter = ScatterSource::kWithinTurn;
  const auto max_order = static_cast<int>(fit.value.size());
  position.series.dof = fit.samples - 2 * max_order - 1;
  const double variance = fit.residual_sum2 / position.series.dof;
  for (Eigen::Index k = 0; k < max_order; ++k)
    position.series.orders.push_back({fit.value[k], variance * fit.cofactor[static_cast<std::size_t>(k)]});
}

/// Where the hob was at the samples, as the table turns meanwhile: what the fit says, which no count rounds.
Eigen::VectorXd HobPlaces_rad(const Eigen::VectorXd& th_rad, const HarmonicSeries& series) {
  return th_rad.unaryExpr([&series](double at_rad) { return at_rad - ValueAt(series, at_rad); });
}

/// What counting repeats in every turn is no scatter between them; where it would not be seen beside that, it is left out.
void AddCounting(const std::vector<Pass>& passes, const TransmissionOptions& options, PositionError& position) {
  constexpr double kWorthCounting = 0.01;  // of the variance
  HarmonicSeries& series = position.series;
  double scatter_rad2 = 0.0;
  for (const Coefficient& order : series.orders) scatter_rad2 += 0.5 * order.cov.trace() / series.Highest();
  const double a_turn = static_cast<double>(position.samples) / position.turns;
  if (!(std::pow(options.hob_step_rad, 2) / 12.0 * 2.0 / a_turn > kWorthCounting * scatter_rad2)) return;
  Eigen::VectorXd th_rad(0);
  for (const Pass& pass : passes) {
    th_rad.conservativeResize(th_rad.size() + std::ssize(pass.th_rad));
    th_rad.tail(std::ssize(pass.th_rad)) = Eigen::Map<const Eigen::VectorXd>(pass.th_rad.data(), std::ssize(pass.th_rad));
  }
  const Eigen::MatrixXd waves = RoundingWaves(HobPlaces_rad(th_rad, series), options.hob_step_rad, 0.0);
  position.of_rounding_rad2 = AddRounding(th_rad, waves, series);
}

/// Samples at the same places of every turn show order k and their number less k as one. What the fits leave in
/// every turn is of orders between these and half of that number; as much is taken to be in those beyond.
void AddFolding(int max_order, PositionError& position) {
  constexpr double kReach = 4.0;         // of fewer orders in the samples of a turn, those that fold are far away
  constexpr double kBeyondChance = 2.0;  // times the variance between turns
  HarmonicSeries& series = position.series;
  const double a_turn = static_cast<double>(position.samples) / position.turns;
  if (kReach * max_order < a_turn) return;
  double between_rad2 = 0.0;  // of one turn
  for (const Coefficient& order : series.orders)
    between_rad2 += 0.5 * order.cov.trace() * position.turns / series.Highest();
  const double left_rad2 = 2.0 / a_turn * std::pow(position.residual_rms_rad, 2);
  if (!(left_rad2 > kBeyondChance * between_rad2)) return;
  position.of_folding_rad2 = left_rad2 - between_rad2;
  for (Coefficient& order : series.orders) order.cov += position.of_folding_rad2 * Eigen::Matrix2d::Identity();
}

void Count(const std::vector<FittedPass>& passes, int max_order, PositionError& position) {
  double sum2 = 0.0;
  int dof = 0;
  for (const FittedPass& pass : passes) {
    position.turns_left_out += pass.left_out;
    for (const FittedTurn& turn : pass.turns) {
      ++position.turns;
      position.samples += turn.fit.samples;
      sum2 += turn.fit.residual_sum2;
      dof += turn.fit.samples - 2 * max_order - 1;
    }
  }
  if (dof > 0) position.residual_rms_rad = std::sqrt(sum2 / dof);
}

/// Mean of the passes whose drift is known.
void FillDrift(const std::vector<FittedPass>& passes, PositionError& position) {
  double sum = 0.0, variance = 0.0;
  int count = 0;
  for (const FittedPass& pass : passes) {
    if (!pass.drift.known) continue;
    sum += pass.drift.rad_per_turn;
    variance += pass.drift.variance;
    ++count;
  }
  if (count == 0) return;
  position.drift_rad_per_turn = sum / count;
  position.u_drift_rad_per_turn = std::sqrt(variance) / count;
}

PositionError MeasurePosition(std::vector<Pass> passes, const TransmissionOptions& options) {
  PositionError position;
  position.setup = passes.front().setup;
  position.direction = passes.front().direction;
  position.head_rad = passes.front().head_rad;
  std::vector<FittedPass> fitted;
  std::vector<std::vector<HobOrder>> of_hob;
  for (Pass& pass : passes) {
    of_hob.push_back(TakeHobOrders(options, pass));
    fitted.push_back(FitPass(pass, options));
  }
  Count(fitted, options.max_order, position);
  if (position.turns == 0) return position;
  position.status = PositionStatus::kOk;
  position.of_hob = MeanOf(of_hob);
  FillDrift(fitted, position);
  if (position.turns > 1) {
    FillFromSeveralTurns(fitted, options, position);
    AddFolding(options.max_order, position);
  } else {
    const auto has_turn = [](const FittedPass& pass) { return !pass.turns.empty(); };
    FillFromOneTurn(std::find_if(fitted.begin(), fitted.end(), has_turn)->turns.front().fit, position);
  }
  if (options.hob_step_rad > 0.0) AddCounting(passes, options, position);
  return position;
}

}  // namespace

std::vector<PositionError> MeasurePositions(const std::vector<HobSample>& samples,
                                            const TransmissionOptions& options, Signal signal) {
  Require(options.max_order > 0 && options.pooled_orders >= 0, "orders must be positive");
  std::vector<PositionError> positions;
  std::vector<Pass> group;
  for (Pass& pass : SortPasses(samples, options, signal)) {
    const bool same =
        !group.empty() && pass.setup == group.front().setup && pass.direction == group.front().direction;
    if (!group.empty() && !same) {
      positions.push_back(MeasurePosition(group, options));
      group.clear();
    }
    group.push_back(std::move(pass));
  }
  if (!group.empty()) positions.push_back(MeasurePosition(group, options));
  return positions;
}

}  // namespace twinbench::separate::hob
