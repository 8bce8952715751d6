#include "twin/diagnose/screen/angles.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "twin/diagnose/screen/circumstances.h"

namespace twinbench::diagnose::screen {

std::vector<AngleArgument> AnglesOf(const LinearRun& run) {
  const Eigen::VectorXd &target = run.schedule.target_rad, &reference = run.schedule.reference_rad;
  std::vector<AngleArgument> all;
  const auto add = [&](const char* name, const Eigen::VectorXd& angle_rad) {
    if (Varies(angle_rad)) all.push_back({name, angle_rad});
  };
  add("target angle", target);
  add("reference angle", reference);
  if (target.size() != reference.size()) return all;
  add("sum of both angles", target + reference);
  add("difference of both angles", target - reference);
  return all;
}

int HighestOrder(const Eigen::VectorXd& angle_rad) {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  constexpr int kMost = 16;
  std::set<long> different;
  for (double a : angle_rad) different.insert(std::lround((a / kTurn - std::floor(a / kTurn)) * 1e4) % 10000);
  return std::min(kMost, (static_cast<int>(different.size()) - 1) / 2);
}

Eigen::MatrixXd Harmonics(const Eigen::VectorXd& angle_rad, const std::vector<double>& orders) {
  Eigen::MatrixXd shapes(angle_rad.size(), 2 * std::ssize(orders));
  for (std::size_t k = 0; k < orders.size(); ++k) {
    const Eigen::ArrayXd phase = orders[k] * angle_rad.array();
    shapes.col(2 * static_cast<Eigen::Index>(k)) = phase.cos();
    shapes.col(2 * static_cast<Eigen::Index>(k) + 1) = phase.sin();
  }
  return shapes.unaryExpr([](double v) { return std::isfinite(v) ? v : 0.0; });
}

std::vector<double> OrdersUpTo(int highest) {
  std::vector<double> orders;
  for (int h = 1; h <= highest; ++h) orders.push_back(h);
  return orders;
}

}  // namespace twinbench::diagnose::screen
