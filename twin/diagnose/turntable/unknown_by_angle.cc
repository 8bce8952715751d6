#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <utility>

#include "twin/core/units.h"
#include "twin/diagnose/turntable/collector.h"

namespace twinbench::diagnose::turntable {
namespace {

/// Orders a of the turntable and b of the multi-tooth table together; pure orders of either are in the tables.
void AddInteractions(Collector& collect) {
  constexpr int kMost = 6;
  std::vector<std::pair<int, int>> orders;
  for (int a = 1; a <= kMost; ++a) {
    for (int b = -kMost; b <= kMost; ++b) {
      if (b != 0 && b != a) orders.emplace_back(a, b);  // a = b is a constant of the set-up
    }
  }
  collect.Add(
      "interaction", static_cast<int>(std::ssize(orders)),
      [c = collect.context(), orders](int g) {
        const auto [a, b] = orders[static_cast<std::size_t>(g)];
        return Wave(a * c->schedule.target_rad + b * c->schedule.reference_rad);
      },
      [orders](int g) {
        const auto [a, b] = orders[static_cast<std::size_t>(g)];
        return fmt::format(
            "order {} turntable {} {} multi-tooth, locked to both angles (interaction), same in both "
            "directions",
            a, b > 0 ? '+' : '-', std::abs(b));
      });
}

/// One order of the turntable angle in each set-up alone.
void AddBySetUp(Collector& collect) {
  const Eigen::MatrixXd which = Indicators(collect, collect.schedule().setup);
  const int last = LargestOrder(collect.turntable());
  if (which.cols() < 2 || which.cols() > 24 || last < 1) return;
  collect.Add(
      "set-up harmonic", last,
      [c = collect.context(), which](int g) {
        Eigen::MatrixXd waves(which.rows(), 2 * which.cols());
        for (Eigen::Index s = 0; s < which.cols(); ++s)
          waves.middleCols(2 * s, 2) = Times(Wave((g + 1) * c->schedule.target_rad), which.col(s));
        return waves;
      },
      [](int g) {
        return fmt::format(
            "order {} locked to target angle that differs from set-up to set-up, same in both "
            "directions",
            g + 1);
      });
}

/// Orders between the whole ones, where the turntable went on turning: within one turn its positions imitate them.
void AddLines(Collector& collect) {
  constexpr double kFewestTurns = 1.4;
  constexpr int kSteps = 10, kLast = 12;
  const Eigen::VectorXd& angle_rad = collect.schedule().target_rad;
  if (angle_rad.maxCoeff() - angle_rad.minCoeff() < kFewestTurns * 2.0 * units::kPi) return;
  std::vector<double> orders;
  for (int k = 2; k < kSteps * kLast; ++k) {
    if (k % kSteps != 0) orders.push_back(static_cast<double>(k) / kSteps);
  }
  collect.Add(
      "line", static_cast<int>(std::ssize(orders)),
      [c = collect.context(), orders](int g) {
        return Wave(orders[static_cast<std::size_t>(g)] * c->schedule.target_rad);
      },
      [orders](int g) {
        return fmt::format("line at {:.3g} per turn, locked to the continued target angle",
                           orders[static_cast<std::size_t>(g)]);
      });
}

}  // namespace

void AddByAngle(Collector& collect) {
  if (collect.turntable().places.HasTeeth()) AddInteractions(collect);
  AddBySetUp(collect);
  AddLines(collect);
}

}  // namespace twinbench::diagnose::turntable
