#include <fmt/format.h>

#include <cmath>
#include <set>

#include "twin/diagnose/turntable/collector.h"

namespace twinbench::diagnose::turntable {
namespace {

void AddHarmonics(Collector& collect, const std::string& table, const Eigen::VectorXd& angle_rad) {
  const int last = LargestOrder(collect.turntable());
  if (last < 1) return;
  collect.Add(
      "direction harmonic", last,
      [direction = DirectionSignal(*collect.context()), angle_rad](int g) {
        return Times(Wave((g + 1) * angle_rad), direction);
      },
      [table](int g) {
        return fmt::format("direction times order {} locked to {} angle, odd in direction", g + 1, table);
      });
}

/// Indicators of the dwells, to a tenth of a second: readings x levels.
Eigen::MatrixXd ByDwell(const Eigen::VectorXd& dwell_s) {
  const Eigen::VectorXd tenths = (10.0 * dwell_s.array()).round();
  std::set<double> levels;
  for (const double d : tenths) {
    if (std::isfinite(d)) levels.insert(d);
  }
  Eigen::MatrixXd by_level = Eigen::MatrixXd::Zero(dwell_s.size(), std::ssize(levels));
  for (Eigen::Index i = 0; i < tenths.size(); ++i) {
    if (std::isfinite(tenths[i])) by_level(i, std::distance(levels.begin(), levels.find(tenths[i]))) = 1.0;
  }
  return by_level;
}

void AddDwells(Collector& collect) {
  constexpr Eigen::Index kMostLevels = 8;
  const Eigen::MatrixXd by_level = ByDwell(collect.schedule().dwell_s);
  if (by_level.cols() < 2 || by_level.cols() > kMostLevels) return;
  collect.Add("dwell", by_level, "depends on the dwell");
  collect.Add("dwell", Times(by_level, DirectionSignal(*collect.context())),
              "direction times a function of the dwell, odd in direction");
}

}  // namespace

void AddByDirection(Collector& collect) {
  AddDwells(collect);
  const Eigen::VectorXd direction = DirectionSignal(*collect.context());
  if (direction.maxCoeff() == direction.minCoeff()) return;
  collect.Add("direction offset", direction, "offset locked to direction, odd in direction");
  AddHarmonics(collect, "target", collect.schedule().target_rad);
  if (collect.turntable().places.HasTeeth()) AddHarmonics(collect, "reference", collect.schedule().reference_rad);
}

}  // namespace twinbench::diagnose::turntable
