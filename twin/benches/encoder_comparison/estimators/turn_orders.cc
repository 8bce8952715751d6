#include "twin/benches/encoder_comparison/estimators/turn_orders.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

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
