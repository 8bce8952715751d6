#include "twin/benches/encoder_comparison/estimators/head_fit.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "twin/core/units.h"

namespace twinbench::separate::encoder {
namespace {

/// The highest order with two stops in each of its waves, and readings to spare.
int HighestOrderOf(const HeadReadings& sorted, int most) {
  const double waves = units::turn / (2.0 * sorted.WidestGap_rad());
  constexpr double kRounding = 1e-6;
  const int by_gaps = static_cast<int>(std::ceil(waves - kRounding)) - 1;
  const int differences = sorted.Values() - static_cast<int>(std::ssize(sorted.stops));
  return std::max(0, std::min({most, by_gaps, differences / 3}));
}

/// What the shaft's place at a stop leaves for the reference: c + e - x, mean over the heads.
double ReferenceShowsMore_rad(const HeadStop& stop, const HeadSolution& solution, const OrdersToFit& orders) {
  const Eigen::VectorXd curve = solution.x.head(2 * std::ssize(orders.orders));
  double sum_rad = 0.0;
  for (const HeadValue& value : stop.values)
    sum_rad += orders.CurveRow(value.ring_rad).dot(curve) + solution.x[orders.ColumnOf(value.setup)] - value.x_rad;
  return sum_rad / static_cast<double>(stop.values.size());
}

harmonics::HarmonicSeries SeriesOf(const HeadSolution& solution, const OrdersToFit& orders) {
  harmonics::HarmonicSeries series;
  series.orders.resize(static_cast<std::size_t>(orders.highest));
  series.dof = solution.dof;
  for (std::size_t i = 0; i < orders.orders.size(); ++i) {
    const auto at = 2 * static_cast<Eigen::Index>(i);
    series.At(orders.orders[i]) = {{solution.x[at], solution.x[at + 1]},
                                   solution.Variance_rad2() * solution.cofactor.block<2, 2>(at, at)};
    if (solution.rounding.size() > 0) series.At(orders.orders[i]).cov += solution.rounding.block<2, 2>(at, at);
  }
  return series;
}

bool IsSeen(const harmonics::HarmonicSeries& series, int order) {
  return order >= 1 && order <= series.Highest() && std::isfinite(series.At(order).value.real());
}

/// Square of the amplitude without what noise makes of it; below zero where the noise was against it.
double Power_rad2(const harmonics::Coefficient& c) {
  return std::norm(c.value) - c.cov.trace();
}

/// Square of the amplitude that an order would have if order x amplitude were that of its four neighbours.
double NeighboursPower_rad2(const harmonics::HarmonicSeries& series, int order) {
  double sum_rad2 = 0.0;
  int count = 0;
  for (const int other : {order - 2, order - 1, order + 1, order + 2}) {
    if (!IsSeen(series, other)) continue;
    sum_rad2 += Power_rad2(series.At(other)) * other * other / (order * order);
    ++count;
  }
  return count > 0 ? std::max(0.0, sum_rad2 / count) : 0.0;
}

double AssumedSize_rad(const harmonics::HarmonicSeries& series, const std::vector<int>& lost) {
  double sum_rad2 = 0.0;
  for (const int order : lost) sum_rad2 += 0.5 * NeighboursPower_rad2(series, order);
  return std::sqrt(sum_rad2);
}

}  // namespace

SeveralHeads BeginHeads(const HeadReadings& sorted, const HeadOptions& options) {
  SeveralHeads result;
  result.heads_rad = sorted.heads_rad;
  result.stops = static_cast<int>(sorted.stops.size());
  result.left_out = sorted.left_out;
  const int highest = HighestOrderOf(sorted, options.max_order);
  if (sorted.stops.empty()) {
    result.not_separated = "no two heads were read at one time";
  } else if (highest == 0) {
    result.not_separated = fmt::format("the heads were read in a part of the turn only: {:.4g} deg are without a measuring position",
                                       sorted.WidestGap_rad() / units::deg);
  }
  result.ring.orders.resize(static_cast<std::size_t>(highest));
  const double most_alike = 1.0 - 1.0 / (options.max_noise_factor * options.max_noise_factor);
  for (int order = 1; order <= highest; ++order) {
    if (Likeness(sorted.heads_rad, order) > most_alike) result.lost.orders.push_back(order);
  }
  if (result.not_separated.empty() && std::ssize(result.lost.orders) == highest)
    result.not_separated = "all heads see the same of every order";
  return result;
}

OrdersToFit OrdersOf(const HeadReadings& sorted, int highest, const std::vector<int>& lost) {
  OrdersToFit orders;
  orders.highest = highest;
  for (int order = 1; order <= highest; ++order) {
    if (!std::ranges::binary_search(lost, order)) orders.orders.push_back(order);
  }
  std::set<int> setups;
  for (const HeadStop& stop : sorted.stops) {
    for (const HeadValue& value : stop.values) setups.insert(value.setup);
  }
  orders.setups.assign(setups.begin(), setups.end());
  return orders;
}

void EnterCurve(const HeadSolution& solution, const OrdersToFit& orders, SeveralHeads& result) {
  result.ring = SeriesOf(solution, orders);
  result.dof = solution.dof;
  result.residual_rms_rad = std::sqrt(solution.Variance_rad2());
  const auto curve = 2 * std::ssize(orders.orders);
  const double rounding = solution.rounding.size() > 0 ? solution.rounding.topLeftCorner(curve, curve).trace() : 0.0;
  if (rounding > 0.0)
    result.rounding_share = rounding / (rounding + solution.Variance_rad2() * solution.cofactor.topLeftCorner(curve, curve).trace());
  result.lost.assumed_rad = AssumedSize_rad(result.ring, result.lost.orders);
}

void EnterReference(const HeadReadings& sorted, const HeadSolution& solution, const OrdersToFit& orders,
                    SeveralHeads& result) {
  // Lost orders of the ring are in it too: they are fitted and then left out.
  const OrdersToFit all = OrdersOf(sorted, orders.highest, {});
  HeadEquations equations(all);
  for (const HeadStop& stop : sorted.stops)
    equations.AddPoint(stop.reference_rad, stop.first_setup, ReferenceShowsMore_rad(stop, solution, orders));
  HeadSolution reference = equations.Solve();
  // The mean of the heads is rounded as any of them; here it counts as if each place were by itself.
  if (solution.rounding.size() > 0)
    reference.rounding = solution.place_rad2 * solution.visits / static_cast<double>(result.heads_rad.size()) * reference.cofactor;
  if (reference.dof < 1.0) {
    result.notes.push_back("too few measuring positions for a curve of the reference");
    return;
  }
  result.reference = SeriesOf(reference, all);
  for (const int order : result.lost.orders) result.reference.At(order) = {};
  // An error of the ring's order comes in as far as the heads see it alike.
  for (const int order : orders.orders)
    result.reference.At(order).cov += Likeness(result.heads_rad, order) * result.ring.At(order).cov;
  const double of_heads_rad2 = result.residual_rms_rad * result.residual_rms_rad /
                               static_cast<double>(result.heads_rad.size());
  result.reference_rms_rad = std::sqrt(std::max(0.0, reference.Variance_rad2() - of_heads_rad2));
}

}  // namespace twinbench::separate::encoder
