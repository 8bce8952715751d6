#include "twin/benches/encoder_comparison/estimators/time_reversal.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "twin/benches/encoder_comparison/estimators/swing_of_speed.h"
#include "twin/benches/encoder_comparison/estimators/turn_orders.h"
#include "twin/core/linear_algebra.h"

namespace twinbench::separate::encoder {
namespace {

std::vector<CoastTurn> AllTurns(const CoastPasses& coast, const CoastOptions& options) {
  std::vector<CoastTurn> turns;
  for (const CoastPass& pass : coast.passes) {
    const Eigen::VectorXd off_rad = OffSmoothCourse(coast, pass, options.course_degree);
    const std::vector<CoastTurn> more = TurnsOf(coast, pass, off_rad, HighestCoastOrder(coast, options));
    turns.insert(turns.end(), more.begin(), more.end());
  }
  return turns;
}

/// Turns x orders.
Eigen::MatrixXcd OrdersOfTurns(const std::vector<CoastTurn>& turns) {
  Eigen::MatrixXcd orders(std::ssize(turns), turns.front().order.size());
  for (Eigen::Index i = 0; i < orders.rows(); ++i) orders.row(i) = turns[static_cast<std::size_t>(i)].order;
  return orders;
}

harmonics::HarmonicSeries SeriesOfRow(const Eigen::RowVectorXcd& value, const Eigen::VectorXd& variance_rad2,
                                      double dof) {
  harmonics::HarmonicSeries series;
  series.dof = dof;
  for (Eigen::Index k = 0; k < value.size(); ++k)
    series.orders.push_back({value[k], variance_rad2[k] * Eigen::Matrix2d::Identity()});
  return series;
}

void SayWhatIsNotTold(const TurnModel& model, TimeReversal& result) {
  if (model.torque < 0)
    result.not_separable.push_back(
        "device and a torque that repeats with the angle, all orders: all turns have about the same speed; it is "
        "counted as the device's");
  if (model.friction < 0)
    result.not_separable.push_back(
        model.torque < 0 ? "device and friction that repeats with the angle, all orders: one sense of rotation at one speed; it is "
                           "counted as the device's"
                         : "torque and friction that repeat with the angle: one sense of rotation");
}

}  // namespace

TimeReversal SeparateByTime(const std::vector<Reading>& readings, const CoastOptions& options) {
  constexpr int kBeyondRounds = 4;   // the first leaves what a torque does to what it does
  constexpr double kTooSmall = 0.1;  // of the curve's noise
  const CoastPasses coast = SortCoast(readings);
  TimeReversal result = BeginCoast(coast);
  if (!result.not_separated.empty()) return result;
  const std::vector<CoastTurn> turns = AllTurns(coast, options);
  if (turns.size() < 4) {
    result.not_separated = "fewer than four turns have the times of all lines";
    return result;
  }
  const TurnModel model = ModelOf(turns);
  const Eigen::MatrixXcd orders = OrdersOfTurns(turns);
  const Eigen::MatrixXd weighted = model.weight.asDiagonal() * model.columns;
  const Eigen::MatrixXd cofactor = SolveSquare(model.columns.transpose() * weighted, Eigen::MatrixXd::Identity(model.columns.cols(), model.columns.cols()));
  const Eigen::MatrixXcd inverse = (cofactor * weighted.transpose()).cast<harmonics::Complex>();
  Eigen::MatrixXcd x = inverse * orders, beyond = Eigen::MatrixXcd::Zero(orders.rows(), orders.cols());
  Eigen::VectorXd moved_rad2 = Eigen::VectorXd::Zero(orders.cols());
  const Eigen::MatrixXd scatter = (orders - model.columns.cast<harmonics::Complex>() * x).cwiseAbs2();
  const auto free = static_cast<double>(2 * (model.columns.rows() - model.columns.cols()));  // re and im
  const double curve_rad2 = (model.weight.transpose() * scatter).sum() * cofactor(0, 0) / free;
  const bool is_steady = LargestBeyond_rad(model, x) < kTooSmall * std::sqrt(curve_rad2);
  for (int round = 0; !is_steady && round < kBeyondRounds; ++round) {
    beyond = BeyondInverseSquare(model, x);
    const Eigen::MatrixXcd next = inverse * (orders - beyond);
    moved_rad2 = (next.row(0) - x.row(0)).cwiseAbs2().transpose();
    x = next;
  }
  const Eigen::MatrixXcd rest = orders - beyond - model.columns.cast<harmonics::Complex>() * x;
  const Eigen::VectorXd own_rad2 = (model.weight.transpose() * rest.cwiseAbs2()).transpose() / free;
  const Eigen::VectorXd unit_rad2 = Pooled(own_rad2, options.pooled_orders);
  result.turns = static_cast<int>(turns.size());
  result.dof = free * (2 * options.pooled_orders + 1);
  result.reference_speed_rad_s = model.reference_speed_rad_s;
  result.stamp_noise_s = std::sqrt(own_rad2.mean() * coast.lines / 2.0);
  result.ring = SeriesOfRow(x.row(0), unit_rad2 * cofactor(0, 0) + moved_rad2, result.dof);
  if (model.torque > 0)
    result.torque =
        SeriesOfRow(x.row(model.torque), unit_rad2 * cofactor(model.torque, model.torque), result.dof);
  if (model.friction > 0)
    result.friction =
        SeriesOfRow(x.row(model.friction), unit_rad2 * cofactor(model.friction, model.friction), result.dof);
  SayWhatIsNotTold(model, result);
  if (result.ring.Highest() < options.max_order)
    result.not_separable.push_back(fmt::format("device, orders above {}: {} lines per turn show them as lower ones", result.ring.Highest(), coast.lines));
  result.ring_by_noise = result.ring;
  SetByOwnAngle(result.ring);
  return result;
}

}  // namespace twinbench::separate::encoder
