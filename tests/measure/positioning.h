#pragma once

#include <cmath>
#include <map>
#include <vector>

#include "twin/benches/encoder_comparison/estimators/iso230_2.h"
#include "twin/core/csv.h"

/// Tests of axes whose figures are known.
namespace twinbench::measure {

/// A target of two runs a side: means m, standard deviations s (two runs m -+ s / sqrt(2) have just that).
inline PositioningTarget TwoRuns(double mean_forward, double s_forward, double mean_backward, double s_backward) {
  const double f = s_forward / std::sqrt(2.0), b = s_backward / std::sqrt(2.0);
  return {0.0, {mean_forward - f, mean_forward + f}, {mean_backward - b, mean_backward + b}};
}

/// Measured figures of a linear axis [mm] with what its report prints; source and licence in the file.
inline std::vector<PositioningTarget> PublishedLinearAxis() {
  const CsvTable table = ReadCsv(TWINBENCH_TEST_DATA "/iso230_2/linear_axis.csv");
  std::map<double, PositioningTarget> by_target;
  for (const CsvTable::Row& row : table.rows) {
    const double target_mm = CsvNumber(table, row, 0, 1.0), actual_mm = CsvNumber(table, row, 3, 1.0);
    PositioningTarget& target = by_target[target_mm];
    (row.fields[1] == "1" ? target.forward : target.backward).push_back(actual_mm - target_mm);
  }
  std::vector<PositioningTarget> test;
  for (const auto& [position, target] : by_target) test.push_back(target);
  return test;
}

}  // namespace twinbench::measure
