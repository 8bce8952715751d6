#include "twin/report/budget_lists.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <map>

namespace twinbench::report {
namespace {

using uncertainty::Budget, uncertainty::Source;

double OfSource(const Budget& budget, const std::string& name) {
  const auto found = std::ranges::find(budget.sources, name, &Source::name);
  return found == budget.sources.end() ? 0.0 : found->u;
}

}  // namespace

std::vector<QuantityList> ListsAmong(const std::vector<Budget>& budgets) {
  std::vector<QuantityList> groups;
  for (const Budget& budget : budgets) {
    const std::string name = uncertainty::KindOf(budget.quantity.name);
    auto group = std::ranges::find(groups, name, &QuantityList::name);
    if (group == groups.end()) group = groups.insert(groups.end(), QuantityList{name, {}});
    group->budgets.push_back(&budget);
  }
  return groups;
}

double FewestDof(const QuantityList& group) {
  double fewest = std::numeric_limits<double>::infinity();
  for (const Budget* budget : group.budgets) fewest = std::min(fewest, budget->dof);
  return fewest;
}

std::vector<ListSource> SourcesOf(const QuantityList& group) {
  std::map<std::string, const Source*> sources;
  for (const Budget* budget : group.budgets) {
    for (const Source& source : budget->sources) sources.try_emplace(source.name, &source);
  }
  const double u = RootMeanSquare(group, [](const Budget& b) { return b.u; });
  std::vector<ListSource> by_size;
  for (const auto& named : sources) {
    const Source* source = named.second;
    const double size = RootMeanSquare(group, [&](const Budget& b) { return OfSource(b, source->name); });
    by_size.push_back({source, size, u > 0.0 ? size * size / (u * u) : 0.0});
  }
  std::ranges::sort(by_size, std::greater<>(), &ListSource::u);
  return by_size;
}

std::string SensitivityUnit(const std::string& unit, const std::string& input_unit) {
  if (input_unit.empty()) return unit;
  return (unit.empty() ? "1" : unit) + "/" + input_unit;
}

}  // namespace twinbench::report
