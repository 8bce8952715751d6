#include "twin/uncertainty/budget.h"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <map>

#include "twin/core/scenario_uncertainty.h"

namespace twinbench::uncertainty {
namespace {

constexpr const char* kReadings = "readings";
constexpr const char* kSecondOrder = "second order";

using Values = std::map<std::string, double>;

Values ValuesWith(Scenario scenario, const std::string& key, std::size_t element, double change,
                  const Evaluate& evaluate) {
  NumbersAt(scenario, key)[element] += change;
  Values values;
  for (const Quantity& q : evaluate(scenario)) values[q.name] = q.value;
  return values;
}

std::string NameOf(const StatedUncertainty& stated, std::size_t element, std::size_t count) {
  return count == 1 ? stated.key : stated.key + "[" + std::to_string(element) + "]";
}

/// What one number of a key does to every quantity; the second-order parts are gathered.
void AddSource(const Source& source, const Values& up, const Values& down, std::vector<Budget>& budgets,
               std::vector<double>& second_order2) {
  for (std::size_t i = 0; i < budgets.size(); ++i) {
    const std::string& name = budgets[i].quantity.name;
    if (!up.contains(name) || !down.contains(name)) continue;
    Source line = source;
    line.u = 0.5 * (up.at(name) - down.at(name));
    budgets[i].sources.push_back(line);
    const double bend = 0.5 * (up.at(name) + down.at(name)) - budgets[i].quantity.value;
    second_order2[i] += 2.0 * bend * bend;
  }
}

void Combine(Budget& budget) {
  double u2 = 0.0, over_dof = 0.0;
  for (const Source& source : budget.sources) {
    u2 += source.u * source.u;
    if (std::isfinite(source.dof) && source.dof > 0.0) over_dof += std::pow(source.u, 4) / source.dof;
  }
  budget.u = std::sqrt(u2);
  if (over_dof > 0.0) budget.dof = u2 * u2 / over_dof;
  budget.k = CoverageFactor(budget.dof);
}

}  // namespace

std::vector<std::string> SourcesOfNothing(const std::vector<Budget>& budgets) {
  std::map<std::string, double> largest;
  for (const Budget& budget : budgets) {
    for (const Source& source : budget.sources) {
      if (source.type != 'B' || source.name == kSecondOrder) continue;
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
    budgets.push_back({quantity, {{kReadings, 'A', quantity.u, quantity.dof}}});
  std::vector<double> second_order2(budgets.size(), 0.0);
  for (const StatedUncertainty& stated : scenario.uncertainties) {
    Scenario copy = scenario;
    const std::size_t count = NumbersAt(copy, stated.key).size();
    for (std::size_t element = 0; element < count; ++element) {
      const Values up = ValuesWith(scenario, stated.key, element, stated.u, evaluate),
                   down = ValuesWith(scenario, stated.key, element, -stated.u, evaluate);
      AddSource({NameOf(stated, element, count), 'B', 0.0, stated.dof}, up, down, budgets, second_order2);
    }
  }
  for (std::size_t i = 0; i < budgets.size(); ++i) {
    if (second_order2[i] > 0.0) budgets[i].sources.push_back({kSecondOrder, 'B', std::sqrt(second_order2[i])});
    Combine(budgets[i]);
  }
  return budgets;
}

}  // namespace twinbench::uncertainty
