#include "twin/uncertainty/budget.h"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <map>
#include <span>

#include "twin/core/scenario_schema.h"
#include "twin/core/scenario_uncertainty.h"
#include "twin/uncertainty/every_run.h"

namespace twinbench::uncertainty {
namespace {

constexpr const char* kReadings = "readings";  // not told apart
constexpr const char* kSecondOrder = "second order";

using Values = std::map<std::string, double>;

Values ValuesOf(const Scenario& scenario, const Evaluate& evaluate) {
  Values values;
  for (const Quantity& q : evaluate(scenario)) values[q.name] = q.value;
  return values;
}

std::string NameOf(const StatedUncertainty& stated, std::size_t element, std::size_t count) {
  return count == 1 ? stated.key : stated.key + "[" + std::to_string(element) + "]";
}

/// A line of the budget for one number of a key, without what it adds.
Source LineOf(const StatedUncertainty& stated, std::size_t element, std::size_t count, const Unit& unit) {
  Source line{NameOf(stated, element, count), 'B', 0.0, stated.dof};
  line.u_input = stated.u / unit.to_SI;
  line.input_unit = unit.suffix;
  return line;
}

Unit UnitOfKey(Scenario& scenario, const std::string& key) {
  for (const ScenarioKey& known : KeysOf(scenario)) {
    if (known.Path() == key) return known.unit;
  }
  return {};
}

/// What the estimator states, part by part.
std::vector<Source> OfReadings(const Quantity& quantity) {
  if (quantity.parts.empty()) return {{kReadings, 'A', quantity.u, quantity.dof}};
  std::vector<Source> sources;
  for (const Part& part : quantity.parts) {
    const char type = IsNotByStatistics(part.name) ? 'B' : 'A';
    if (part.share > 0.0) sources.push_back({part.name, type, quantity.u * std::sqrt(part.share), quantity.dof});
  }
  return sources;
}

/// What one number of a key does to every quantity; the second-order parts are gathered.
void AddSource(const Source& source, const Values& up, const Values& down, std::vector<Budget>& budgets,
               std::vector<double>& second_order2) {
  for (std::size_t i = 0; i < budgets.size(); ++i) {
    const std::string& name = budgets[i].quantity.name;
    if (!up.contains(name) || !down.contains(name)) continue;
    Source line = source;
    line.u = 0.5 * (up.at(name) - down.at(name));
    line.sensitivity = line.u / line.u_input;
    budgets[i].sources.push_back(line);
    const double bend = 0.5 * (up.at(name) + down.at(name)) - budgets[i].quantity.value;
    second_order2[i] += 2.0 * bend * bend;
  }
}

/// In a line with what the estimator says of its own second order, if it does.
void AddSecondOrder(double variance, Budget& budget) {
  if (!(variance > 0.0)) return;
  const auto own = std::ranges::find(budget.sources, kSecondOrder, &Source::name);
  if (own != budget.sources.end())
    own->u = std::hypot(own->u, std::sqrt(variance));
  else
    budget.sources.push_back({kSecondOrder, 'B', std::sqrt(variance)});
}

void Combine(Budget& budget) {
  double u2 = 0.0, over_dof = 0.0;
  const auto add_dof = [&](double u, double dof) {
    if (std::isfinite(dof) && dof > 0.0) over_dof += std::pow(u, 4) / dof;
  };
  add_dof(budget.quantity.u, budget.quantity.dof);
  for (const Source& source : budget.sources) {
    u2 += source.u * source.u;
    if (!IsOfReadings(source)) add_dof(source.u, source.dof);
  }
  budget.u = std::sqrt(u2);
  if (over_dof > 0.0) budget.dof = u2 * u2 / over_dof;
  budget.k = CoverageFactor(budget.dof);
}

}  // namespace

bool IsOfReadings(const Source& source) {
  return !std::isfinite(source.u_input);
}

std::vector<std::string> SourcesOfNothing(const std::vector<Budget>& budgets) {
  std::map<std::string, double> largest;
  for (const Budget& budget : budgets) {
    for (const Source& source : budget.sources) {
      if (IsOfReadings(source)) continue;
      double& u = largest[source.name];
      u = std::max(u, std::abs(source.u));
    }
  }
  std::vector<std::string> names;
  for (const auto& [name, u] : largest) {
    if (u == 0.0) names.push_back(name);
  }
  return names;
}

double CoverageFactor(double dof) {
  constexpr double kUpper = 0.975;
  if (!std::isfinite(dof)) return boost::math::quantile(boost::math::normal(), kUpper);
  return boost::math::quantile(boost::math::students_t(std::max(dof, 1.0)), kUpper);
}

std::vector<Budget> Budgets(const Scenario& scenario, const Evaluate& evaluate) {
  std::vector<Budget> budgets;
  for (const Quantity& quantity : evaluate(scenario))
    budgets.push_back({quantity, OfReadings(quantity)});
  std::vector<double> second_order2(budgets.size(), 0.0);
  for (const StatedUncertainty& stated : scenario.uncertainties) {
    Scenario changed = scenario;
    const std::span<double> numbers = NumbersAt(changed, stated.key);
    const Unit unit = UnitOfKey(changed, stated.key);
    for (std::size_t element = 0; element < numbers.size(); ++element) {
      const double nominal = numbers[element];
      numbers[element] = nominal + stated.u;
      const Values up = ValuesOf(changed, evaluate);
      numbers[element] = nominal - stated.u;
      const Values down = ValuesOf(changed, evaluate);
      numbers[element] = nominal;
      AddSource(LineOf(stated, element, numbers.size(), unit), up, down, budgets, second_order2);
    }
  }
  for (std::size_t i = 0; i < budgets.size(); ++i) {
    AddSecondOrder(second_order2[i], budgets[i]);
    Combine(budgets[i]);
  }
  return budgets;
}

}  // namespace twinbench::uncertainty
