#include "twin/benches/encoder_comparison/estimators/turn_orders.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "twin/core/units.h"

namespace twinbench::separate::encoder {

TurnModel ModelOf(const std::vector<CoastTurn>& turns) {
  constexpr double kSpread = 1.5;  // of the squares of the speeds, for a torque to be told from the ring
  TurnModel model;
  const auto rows = std::ssize(turns);
  Eigen::VectorXd speed(rows), sense(rows);
  for (Eigen::Index i = 0; i < rows; ++i) {
    speed[i] = turns[static_cast<std::size_t>(i)].speed_rad_s;
    sense[i] = turns[static_cast<std::size_t>(i)].direction;
  }
  model.reference_speed_rad_s = speed.maxCoeff();
  model.weight = speed.array().inverse().square();
  const Eigen::VectorXd slowness = model.reference_speed_rad_s * model.reference_speed_rad_s * model.weight;
  model.columns = Eigen::MatrixXd::Ones(rows, 1);
  const auto add = [&model](const Eigen::VectorXd& column) {
    model.columns.conservativeResize(Eigen::NoChange, model.columns.cols() + 1);
    model.columns.rightCols(1) = column;
    return static_cast<int>(model.columns.cols()) - 1;
  };
  if (slowness.maxCoeff() > kSpread * slowness.minCoeff()) model.torque = add(slowness);
  if (sense.maxCoeff() > sense.minCoeff()) model.friction = add(sense.cwiseProduct(slowness));
  return model;
}

Eigen::VectorXd Pooled(const Eigen::VectorXd& of_order, int pooled) {
  const Eigen::Index count = of_order.size();
  Eigen::VectorXd means(count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const Eigen::Index side = std::min<Eigen::Index>({pooled, k, count - 1 - k});
    means[k] = of_order.segment(k - side, 2 * side + 1).mean();
  }
  return means;
}

void SetByOwnAngle(harmonics::HarmonicSeries& ring) {
  constexpr int kRounds = 6;  // each takes what is left down by the slope of the curve
  const int points = 4 * ring.Highest();
  Eigen::VectorXd error_rad = Eigen::VectorXd::Zero(points);
  double slope2 = 0.0;
  for (int k = 1; k <= ring.Highest(); ++k) slope2 += 0.5 * k * k * std::norm(ring.At(k).value);
  const Eigen::VectorXd before_rad = harmonics::Resample(ring, points);
  for (int round = 0; round < kRounds; ++round) {
    for (int i = 0; i < points; ++i) error_rad[i] = ValueAt(ring, units::turn * i / points + error_rad[i]);
  }
  const double left_rad2 = slope2 * (error_rad - before_rad).squaredNorm() / points;
  for (int k = 1; k <= ring.Highest(); ++k) {
    ring.At(k).cov += left_rad2 / ring.Highest() * Eigen::Matrix2d::Identity();
    ring.At(k).value = 0.0;
    for (int i = 0; i < points; ++i)
      ring.At(k).value +=
          2.0 / points * std::polar(1.0, -units::turn * (static_cast<double>(k) * i / points)) * error_rad[i];
  }
}

TimeReversal BeginCoast(const CoastPasses& coast) {
  TimeReversal result;
  result.lines = coast.lines;
  result.passes = static_cast<int>(coast.passes.size());
  result.left_out = coast.left_out;
  constexpr std::size_t kTurns = 3;  // for a course that is smooth from turn to turn
  const auto is_short = [&](const CoastPass& pass) {
    return pass.line.size() <= kTurns * static_cast<std::size_t>(coast.lines) + 1;
  };
  if (coast.lines < 8) {
    result.not_separated = "the times of at least 8 lines per turn are needed, one after the other";
  } else if (std::ranges::any_of(coast.passes, is_short)) {
    result.not_separated = fmt::format("a pass has no more than {} turns", kTurns);
  }
  return result;
}

int HighestCoastOrder(const CoastPasses& coast, const CoastOptions& options) {
  return std::min(options.max_order, (coast.lines - 1) / 2);
}

}  // namespace twinbench::separate::encoder
