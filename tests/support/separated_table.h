#pragma once

#include "twin/benches/rotary_4dof/estimators/separate.h"

/// What was separated of the rotary bench's tables, beside what is true.
namespace twinbench::test {

/// rms of a - b over the positions where both are finite; NaN if there are none.
inline double RmsDifference(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0;
  int count = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (!std::isfinite(a[i]) || !std::isfinite(b[i])) continue;
    sum += (a[i] - b[i]) * (a[i] - b[i]);
    ++count;
  }
  return std::sqrt(sum / count);
}

struct SeparatedTable {
  separate::Table table;
  separate::TableEstimate estimate;
  TableErrors truth;  // what cannot be separated left out of it

  double RmsError(Component c) const { return RmsDifference(estimate.value[c], truth[c]); }
  double ErrorOverU(Component c) const {
    return RmsError(c) / RmsDifference(estimate.u[c], std::vector<double>(truth[c].size(), 0.0));
  }
  std::string Name(Component c) const {
    return std::string(separate::TableName(table)) + ' ' + kComponentNames[static_cast<std::size_t>(c)];
  }
};

/// @param truth  With `target` and `reference`.
template <class Truth>
std::vector<SeparatedTable> BothTables(const separate::Separation& s, const Truth& truth) {
  using enum separate::Table;
  return {{kTarget, s.target, separate::RemoveNotSeparable(truth.target, kTarget, s.not_separable)},
          {kReference, s.reference, separate::RemoveNotSeparable(truth.reference, kReference, s.not_separable)}};
}

}  // namespace twinbench::test
