#include <fmt/format.h>

#include <map>

#include "twin/diagnose/encoder/collector.h"

namespace twinbench::diagnose::encoder {
namespace {

/// Indicators of the passes, or of the set-ups: readings x values of the label.
Eigen::MatrixXd Indicators(const std::vector<int>& label) {
  std::map<int, Eigen::Index> column;
  for (const int value : label) column.try_emplace(value, std::ssize(column));
  Eigen::MatrixXd indicators = Eigen::MatrixXd::Zero(std::ssize(label), std::ssize(column));
  for (std::size_t i = 0; i < label.size(); ++i)
    indicators(static_cast<Eigen::Index>(i), column.at(label[i])) = 1.0;
  return indicators;
}

/// Offsets, and waves of low orders, that differ from one value of a label to the next.
void AddByLabel(Collector& collect, const std::string& what, const std::vector<int>& label, bool offsets) {
  constexpr int kLastOrder = 3, kMostLabels = 24;
  const Eigen::MatrixXd which = Indicators(label);
  if (which.cols() < 2 || which.cols() > kMostLabels) return;
  if (offsets) collect.Add(what, which, fmt::format("offset of each {0}, locked to the {0}", what));
  const Eigen::VectorXd angle_rad = collect.context().device_rad;
  collect.Add(
      what + " harmonic", kLastOrder,
      [=](int g) {
        Eigen::MatrixXd waves(which.rows(), 2 * which.cols());
        for (Eigen::Index p = 0; p < which.cols(); ++p)
          waves.middleCols(2 * p, 2) = Times(Wave((g + 1) * angle_rad), which.col(p));
        return waves;
      },
      [=](int g) {
        return fmt::format("order {} locked to reference angle that differs from {} to {}", g + 1, what, what);
      });
}

}  // namespace

void AddByPassAndSetUp(Collector& collect) {
  AddByLabel(collect, "pass", collect.context().pass, true);
  AddByLabel(collect, "set-up", collect.context().setup, false);
}

}  // namespace twinbench::diagnose::encoder
