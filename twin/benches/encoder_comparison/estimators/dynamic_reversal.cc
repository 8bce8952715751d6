#include <algorithm>
#include <cmath>
#include <map>

#include "twin/benches/encoder_comparison/estimators/method_distance.h"
#include "twin/benches/encoder_comparison/estimators/turn_orders.h"
#include "twin/separate/mean.h"

namespace twinbench::separate::encoder {
namespace {

/// Turns of about one speed in one sense.
struct TurnGroup {
  Eigen::VectorXcd sum;
  double inverse_square = 0.0, square = 0.0;  // sums of speed^-2 and speed^2
  int count = 0;

  void Add(const CoastTurn& turn) {
    sum = count == 0 ? turn.order : Eigen::VectorXcd(sum + turn.order);
    inverse_square += 1.0 / (turn.speed_rad_s * turn.speed_rad_s);
    square += turn.speed_rad_s * turn.speed_rad_s;
    ++count;
  }
};

/// Mean of both senses at about one speed: value, speed^-2, and its variance by unit noise of the times.
struct AtSpeed {
  Eigen::VectorXcd order;
  double slowness = 0.0, cofactor = 0.0;
};
AtSpeed MeanOfSenses(const std::map<int, TurnGroup>& senses) {
  AtSpeed mean{Eigen::VectorXcd::Zero(senses.begin()->second.sum.size())};
  const auto count = static_cast<double>(senses.size());
  for (const auto& [sense, group] : senses) {
    mean.order += group.sum / (group.count * count);
    mean.slowness += group.inverse_square / (group.count * count);
    mean.cofactor += group.square / std::pow(group.count, 2) / (count * count);
  }
  return mean;
}

/// To where a torque moves nothing.
AtSpeed Extrapolated(const AtSpeed& fast, const AtSpeed& slow) {
  const double apart = slow.slowness - fast.slowness, a = slow.slowness / apart, b = fast.slowness / apart;
  return {a * fast.order - b * slow.order, 0.0, a * a * fast.cofactor + b * b * slow.cofactor};
}

/// Scatter of the turns of a pass about their mean, for times of unit noise: by order.
Eigen::VectorXd ScatterWithinPasses(const std::vector<std::vector<CoastTurn>>& passes) {
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(passes.front().front().order.size());
  double free = 0.0;
  for (const std::vector<CoastTurn>& turns : passes) {
    TurnGroup all;
    for (const CoastTurn& turn : turns) all.Add(turn);
    const Eigen::VectorXcd mean = all.sum / all.count;
    for (const CoastTurn& turn : turns)
      squares += (turn.order - mean).cwiseAbs2() / (turn.speed_rad_s * turn.speed_rad_s);
    free += 2.0 * (all.count - 1);
  }
  return squares / free;
}

}  // namespace

TimeReversal DynamicReversal(const std::vector<Reading>& readings, const CoastOptions& options) {
  const CoastPasses coast = SortCoast(readings);
  TimeReversal result = BeginCoast(coast);
  if (!result.not_separated.empty()) return result;
  std::vector<std::vector<CoastTurn>> passes;
  std::vector<double> speeds;
  for (const CoastPass& pass : coast.passes) {
    std::vector<CoastTurn> turns =
        TurnsOf(coast, pass, OffClosedTurns(coast, pass), HighestCoastOrder(coast, options));
    if (turns.size() < 2) continue;
    for (const CoastTurn& turn : turns) speeds.push_back(turn.speed_rad_s);
    result.turns += static_cast<int>(turns.size());
    passes.push_back(std::move(turns));
  }
  if (passes.empty()) {
    result.not_separated = "no pass has two turns that close with the next one";
    return result;
  }
  const auto [least, most] = std::ranges::minmax(speeds);
  const bool two_speeds = most * most > 1.5 * least * least;
  std::map<int, TurnGroup> fast, slow;  // by sense
  for (const std::vector<CoastTurn>& turns : passes) {
    const bool is_slow = two_speeds && turns.front().speed_rad_s < std::sqrt(least * most);
    for (const CoastTurn& turn : turns) (is_slow ? slow : fast)[turn.direction].Add(turn);
  }
  const AtSpeed at = slow.empty() ? MeanOfSenses(fast) : Extrapolated(MeanOfSenses(fast), MeanOfSenses(slow));
  const Eigen::VectorXd own_rad2 = ScatterWithinPasses(passes);
  const Eigen::VectorXd unit_rad2 = Pooled(own_rad2, options.pooled_orders);
  result.dof = 2.0 * (result.turns - static_cast<double>(passes.size())) * (2 * options.pooled_orders + 1);
  result.reference_speed_rad_s = most;
  result.stamp_noise_s = std::sqrt(own_rad2.mean() * coast.lines / 2.0);
  result.ring.dof = result.dof;
  for (Eigen::Index k = 0; k < at.order.size(); ++k)
    result.ring.orders.push_back({at.order[k], unit_rad2[k] * at.cofactor * Eigen::Matrix2d::Identity()});
  if (slow.empty())
    result.not_separable.push_back(
        "device and a torque that repeats with the angle, all orders: all turns have about the same speed; it is "
        "counted as the device's");
  result.ring_by_noise = result.ring;
  SetByOwnAngle(result.ring);
  const std::string biased = WidenByDistance(SeparateByTime(readings, options).ring, result.ring);
  if (!biased.empty()) result.notes.push_back(BiasNote(biased));
  return result;
}

}  // namespace twinbench::separate::encoder
