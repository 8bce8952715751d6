#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "twin/core/units.h"
#include "twin/diagnose/tuning.h"
#include "twin/diagnose/unknown/collector.h"
#include "twin/model/signals.h"

namespace twinbench::diagnose::unknown {
namespace {

/// Whole orders that no unknown takes up.
void AddHarmonics(Collector& collect, const Angle& angle) {
  if (angle.first_unfree < 1 || angle.last_order < angle.first_unfree) return;
  std::vector<int> orders = angle.orders;
  for (int k = angle.first_unfree; angle.orders.empty() && k <= angle.last_order; ++k) orders.push_back(k);
  const auto order_of = [orders](int g) { return orders[static_cast<std::size_t>(g)]; };
  collect.AddWaves(angle.harmonics, {angle.rad, 0.0, 1.0, orders}, [order_of, name = angle.name](int g) {
    return fmt::format("harmonic of order {} synchronous with {}, same in both directions", order_of(g), name);
  });
  if (!angle.by.empty())
    collect.Are([order_of, by = angle.by](const Eigen::VectorXd&, int g) {
      return WaveOf(SignalOf("harmonic", by, {{"order", order_of(g)}}));
    });
}

/// The order itself, or the nearest that is `nearest` away from a whole one: a line between the orders that is
/// refined must not become one of them, for those have names.
double AwayFromWhole(double order, double nearest) {
  const double whole = std::round(order), off = order - whole;
  return std::abs(off) >= nearest ? order : whole + std::copysign(nearest, off);
}

/// Lines between the whole orders, a tenth of the resolution apart as far as that can be afforded. Nearer to a
/// whole order than the run can tell there are none; and none at all in a single turn where whole orders are not
/// free: they imitate any line between them.
void AddLines(Collector& collect) {
  const Design& d = collect.design();
  const Angle& angle = d.angles.front();
  const double turns = std::max(TurnsOf(d), 0.1);
  if (angle.first_unfree > 0 && turns < tuning::kFewestTurns) return;
  const double last = std::min(60.0, angle.last_order + 0.5);
  const double step =
      std::max(std::clamp(0.1 / turns, 0.01, 0.1), (last - tuning::kFirstLine) / tuning::kMostLines);
  const double nearest = std::clamp(0.2 / turns, 0.01, 0.45);
  Shape order{"order", "1", 1.0, tuning::kFirstLine, std::max(last, tuning::kFirstLine + step), {}};
  std::vector<int> number;  // of each value among all steps
  for (int j = 0; tuning::kFirstLine + j * step <= last; ++j) {
    const double k = tuning::kFirstLine + j * step;
    if (std::abs(k - std::round(k)) <= nearest) continue;
    order.value.push_back(k);
    number.push_back(j);
  }
  if (number.empty()) return;
  collect.AddWaves(
      "line", {d.continued_rad, tuning::kFirstLine, step, number, d.moved},
      [nearest, name = angle.name](const Eigen::VectorXd& k) {
        return fmt::format("line at {:.3f} per turn synchronous with {}, same in both directions", AwayFromWhole(k[0], nearest), name);
      },
      order,
      [design = collect.shared(), nearest](const Eigen::VectorXd& k) {
        return model::Times(model::Wave(AwayFromWhole(k[0], nearest) * design->continued_rad), design->moved);
      });
  if (TimeFollowsAngle(d)) collect.GoByTime();
  if (!angle.by.empty())
    collect.Are([nearest, by = angle.by](const Eigen::VectorXd& k, int) {
      return WaveOf(SignalOf("harmonic", by, {{"order", AwayFromWhole(k[0], nearest)}}));
    });
}

/// Orders a of one angle and b of another together, where each angle's own orders are free.
void AddInteractions(Collector& collect) {
  const Design& d = collect.design();
  if (d.angles.size() < 2 || d.angles[0].first_unfree > 0 || d.angles[1].first_unfree > 0) return;
  const int last = std::min({tuning::kInteractionOrders, d.angles[0].last_order, d.angles[1].last_order});
  std::vector<std::pair<int, int>> orders;
  for (int a = 1; a <= last; ++a) {
    for (int b = -last; b <= last; ++b) {
      if (b != 0 && b != a) orders.emplace_back(a, b);  // a = b is a constant of the set-up
    }
  }
  const auto words = [first = d.angles[0].name, second = d.angles[1].name, orders](int g) {
    const auto [a, b] = orders[static_cast<std::size_t>(g)];
    return fmt::format("order {} {} {} {} {}, synchronous with both angles (interaction), same in both directions", a,
                       first, b > 0 ? '+' : '-', std::abs(b), second);
  };
  collect.Add(
      "interaction", static_cast<int>(std::ssize(orders)),
      [design = collect.shared(), orders](int g) {
        const auto [a, b] = orders[static_cast<std::size_t>(g)];
        return model::Times(model::Wave(a * design->angles[0].rad + b * design->angles[1].rad), design->moved);
      },
      words);
  collect.Are([orders](const Eigen::VectorXd&, int g) {
    const auto [a, b] = orders[static_cast<std::size_t>(g)];
    return WaveOf(SignalOf("interaction", "", {{"order", a}, {"with_order", b}}));
  });
}

}  // namespace

void AddByAngle(Collector& collect) {
  if (collect.design().angles.empty()) return;
  for (const Angle& angle : collect.design().angles) AddHarmonics(collect, angle);
  AddLines(collect);
  AddInteractions(collect);
}

}  // namespace twinbench::diagnose::unknown
