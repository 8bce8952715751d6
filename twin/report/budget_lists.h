#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "twin/uncertainty/budget.h"

/// Budgets of results that are many places of one quantity, as one.
namespace twinbench::report {

inline constexpr std::size_t kBudgetWidth = 100;  // characters of a table

/// Budgets of one kind of result, in the order of the results.
struct QuantityList {
  std::string name;
  std::vector<const uncertainty::Budget*> budgets;
};

std::vector<QuantityList> ListsAmong(const std::vector<uncertainty::Budget>& budgets);

template <class Of>
double RootMeanSquare(const QuantityList& group, Of of) {
  double sum = 0.0;
  for (const uncertainty::Budget* budget : group.budgets) sum += of(*budget) * of(*budget);
  return std::sqrt(sum / static_cast<double>(group.budgets.size()));
}

/// Of the value that has fewest.
double FewestDof(const QuantityList& group);

/// One source over a list: root mean square of what it adds.
struct ListSource {
  const uncertainty::Source* source = nullptr;
  double u = 0.0;
  double share = 0.0;  // of u^2
};

/// Largest first.
std::vector<ListSource> SourcesOf(const QuantityList& group);

/// "arcsec/nm"
std::string SensitivityUnit(const std::string& unit, const std::string& input_unit);

}  // namespace twinbench::report
