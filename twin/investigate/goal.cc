#include "twin/investigate/goal.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <regex>

#include "twin/core/errors.h"
#include "twin/uncertainty/every_run.h"
#include "twin/uncertainty/quantities.h"

namespace twinbench::investigate {
namespace {

constexpr const char* kExpected =
    "a quantity of results.json and its standard uncertainty: \"target.ez 0.1arcsec\"";

/// "target.ez_arcsec" of the goal is "separation.target.ez_arcsec" of the results.
bool Ends(const std::string& name, const std::string& wanted) {
  if (!name.ends_with(wanted)) return false;
  return name.size() == wanted.size() || name[name.size() - wanted.size() - 1] == '.';
}

/// What a standard or a model has in it, and every constant of the scenario.
bool IsShared(const uncertainty::Source& source) {
  return source.type == 'B' && source.name != uncertainty::kRoundingOfReadings;
}

}  // namespace

std::string Goal::Text() const {
  return fmt::format("u of {} {:.3g}{}{}", quantity, u, unit.empty() ? "" : " ", unit);
}

Goal ParseGoal(const std::string& text) {
  static const std::regex pattern(R"(\s*([A-Za-z_][\w.]*)\s+([0-9.]+(?:[eE][-+]?\d+)?)\s*([A-Za-z_/]*)\s*)");
  std::smatch match;
  if (!std::regex_match(text, match, pattern)) throw InputError("--goal " + text, "cannot be read", kExpected);
  Goal goal{match[1], match[3], std::strtod(match[2].str().c_str(), nullptr)};
  if (!(goal.u > 0.0)) throw InputError("--goal " + text, "asks for nothing", "an uncertainty above 0");
  return goal;
}

bool Certainty::IsOfGoal(const std::string& quantity) const {
  const std::string wanted = goal_.unit.empty() ? goal_.quantity : goal_.quantity + "_" + goal_.unit;
  return Ends(uncertainty::ListOf(quantity), wanted);
}

Certainty::Precision Certainty::Of(const nlohmann::json& results) const {
  Precision precision;
  for (const uncertainty::Quantity& q : uncertainty::QuantitiesOf(results)) {
    const double own = uncertainty::OwnShare(q);
    if (IsOfGoal(q.name) && q.u > 0.0 && own > 0.0) precision[q.name] = 1.0 / (own * q.u * q.u);
  }
  return precision;
}

void Certainty::Share(const std::vector<uncertainty::Budget>& budgets) {
  shared_.clear();
  shared_by_source_.clear();
  for (const uncertainty::Budget& budget : budgets) {
    if (!IsOfGoal(budget.quantity.name)) continue;
    for (const uncertainty::Source& source : budget.sources) {
      if (!IsShared(source)) continue;
      shared_[budget.quantity.name] += source.u * source.u;
      shared_by_source_[source.name] += source.u * source.u;
    }
  }
}

double Certainty::SharedU() const {
  double sum = 0.0;
  for (const auto& [place, variance] : shared_) sum += variance;
  return shared_.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(std::max(shared_.size(), precision_.size())));
}

std::string Certainty::LargestShared() const {
  const auto most = std::ranges::max_element(shared_by_source_, {}, [](const auto& s) { return s.second; });
  return most == shared_by_source_.end() ? "" : most->first;
}

double Certainty::RootMeanSquare(const Precision& precision) const {
  if (precision.empty()) return std::numeric_limits<double>::infinity();
  double sum = 0.0;
  for (const auto& [place, p] : precision) {
    const auto shared = shared_.find(place);
    sum += 1.0 / p + (shared == shared_.end() ? 0.0 : shared->second);
  }
  return std::sqrt(sum / static_cast<double>(precision.size()));
}

bool Certainty::Add(const nlohmann::json& results) {
  const Precision more = Of(results);
  for (const auto& [place, p] : more) precision_[place] += p;
  return !more.empty();
}

double Certainty::u() const {
  return RootMeanSquare(precision_);
}

double Certainty::With(const nlohmann::json& results) const {
  Precision both = precision_;
  for (const auto& [place, p] : Of(results)) both[place] += p;
  return RootMeanSquare(both);
}

std::vector<uncertainty::Budget> BudgetsOf(const std::vector<Reading>& readings, const Scenario& scenario, const Means& means) {
  return uncertainty::Budgets(scenario, [&](const Scenario& other) {
    return uncertainty::QuantitiesOf(means.evaluate(readings, other));
  });
}

std::vector<std::string> GoalNames(const nlohmann::json& results) {
  std::vector<std::string> names;
  for (const uncertainty::Quantity& q : uncertainty::QuantitiesOf(results)) {
    const std::string list = uncertainty::ListOf(q.name);
    const bool can_be_asked_for = list.find('[') == std::string::npos;
    if (can_be_asked_for && std::ranges::find(names, list) == names.end()) names.push_back(list);
  }
  return names;
}

}  // namespace twinbench::investigate
