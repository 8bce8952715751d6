#include <cmath>
#include <iterator>
#include <set>

#include "twin/diagnose/rotary/signals.h"
#include "twin/diagnose/rotary/unknown_collector.h"

namespace twinbench::diagnose::rotary {
namespace {

double ToTenths_s(double dwell_s) {
  return std::round(dwell_s * 10.0) / 10.0;
}

std::set<double> Levels_s(const Eigen::VectorXd& dwell_s) {
  std::set<double> levels_s;
  for (const double d_s : dwell_s) {
    if (std::isfinite(d_s)) levels_s.insert(ToTenths_s(d_s));
  }
  return levels_s;
}

/// Indicators of the dwells: readings x levels.
Eigen::MatrixXd ByLevel(const Eigen::VectorXd& dwell_s, const std::set<double>& levels_s) {
  Eigen::MatrixXd by_level = Eigen::MatrixXd::Zero(dwell_s.size(), std::ssize(levels_s));
  for (Eigen::Index i = 0; i < by_level.rows(); ++i) {
    const auto found = levels_s.find(ToTenths_s(dwell_s[i]));
    if (found != levels_s.end()) by_level(i, std::distance(levels_s.begin(), found)) = 1.0;
  }
  return by_level;
}

}  // namespace

void AddByDwell(Collector& collect) {
  constexpr std::ptrdiff_t kMostLevels = 8;
  const Schedule& s = collect.schedule();
  const std::set<double> levels_s = Levels_s(s.dwell_s);
  if (std::ssize(levels_s) < 2 || std::ssize(levels_s) > kMostLevels) return;
  const Eigen::MatrixXd by_level = ByLevel(s.dwell_s, levels_s);
  collect.Add("dwell", by_level, "depends on the dwell");
  collect.Add("dwell", by_level.array().colwise() * DirectionSignal(s).array(),
              "direction times a function of the dwell, odd in direction");
}

}  // namespace twinbench::diagnose::rotary
