#include <fmt/format.h>

#include <cstdlib>
#include <utility>

#include "twin/diagnose/rotary/signals.h"
#include "twin/diagnose/rotary/unknown_collector.h"

namespace twinbench::diagnose::rotary {
namespace {

/// Orders a of the target and b of the reference together; pure orders of either are in the tables.
std::vector<std::pair<int, int>> JointOrders() {
  constexpr int kMost = 8;
  std::vector<std::pair<int, int>> orders;
  for (int a = 1; a <= kMost; ++a) {
    for (int b = -kMost; b <= kMost; ++b) {
      if (b != 0 && b != a) orders.emplace_back(a, b);  // a = b is a constant of the set-up
    }
  }
  return orders;
}

void AddInteractions(Collector& collect) {
  const auto orders = JointOrders();
  collect.Add(
      "interaction", static_cast<int>(std::ssize(orders)),
      [&s = collect.schedule(), in = InCircle(collect.schedule()), orders](int g) {
        const auto [a, b] = orders[static_cast<std::size_t>(g)];
        return Wave(a * s.target_rad + b * s.reference_rad, in);
      },
      [orders](int g) {
        const auto [a, b] = orders[static_cast<std::size_t>(g)];
        return fmt::format(
            "order {} target {} {} reference, locked to both angles (interaction), same in both directions", a,
            b > 0 ? '+' : '-', std::abs(b));
      });
}

/// From a tenth of a period a turn to twelve; whole orders belong to the tables.
std::vector<double> LineOrders() {
  constexpr int kStepsAnOrder = 20;
  std::vector<double> orders;
  for (int k = 2; k <= 12 * kStepsAnOrder; ++k) {
    if (k % kStepsAnOrder != 0) orders.push_back(0.05 * k);
  }
  return orders;
}

void AddLines(Collector& collect) {
  const Schedule& s = collect.schedule();
  const std::vector<double> orders = LineOrders();
  collect.Add(
      "line", static_cast<int>(std::ssize(orders)),
      [angle_rad = ContinuedTarget_rad(s, false), in = InCircle(s), orders](int g) {
        return Wave(orders[static_cast<std::size_t>(g)] * angle_rad, in);
      },
      [orders](int g) {
        return fmt::format("line at {:.3g} per turn, locked to the continued target angle",
                           orders[static_cast<std::size_t>(g)]);
      });
}

}  // namespace

void AddByAngle(Collector& collect) {
  AddInteractions(collect);
  AddLines(collect);
}

}  // namespace twinbench::diagnose::rotary
