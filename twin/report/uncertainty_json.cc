#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "twin/report/budget_lists.h"
#include "twin/report/uncertainty_text.h"
#include "twin/uncertainty/agreement.h"

namespace twinbench::report {
namespace {

using Json = nlohmann::json;
using uncertainty::Budget, uncertainty::MonteCarlo, uncertainty::Source, uncertainty::Spread;

Json NumberOrNull(double value) {
  return std::isfinite(value) ? Json(value) : Json();
}

Json ListJson(const QuantityList& group) {
  const double u = RootMeanSquare(group, [](const Budget& b) { return b.u; });
  const double expanded = RootMeanSquare(group, [](const Budget& b) { return b.Expanded(); });
  Json sources = Json::array();
  for (const ListSource& s : SourcesOf(group)) {
    sources.push_back({{"source", s.source->name},
                       {"type", std::string(1, s.source->type)},
                       {"u", NumberOrNull(s.u)},
                       {"dof", NumberOrNull(s.source->dof)},
                       {"share", NumberOrNull(s.share)}});
    if (uncertainty::IsOfReadings(*s.source)) continue;
    sources.back()["u_input"] = s.source->u_input;
    sources.back()["sensitivity"] = NumberOrNull(s.u / s.source->u_input);
    sources.back()["sensitivity_unit"] = SensitivityUnit(uncertainty::UnitOf(group.name), s.source->input_unit);
  }
  return {{"name", group.name},          {"values", group.budgets.size()},
          {"u", NumberOrNull(u)},        {"k", NumberOrNull(expanded / u)},
          {"U", NumberOrNull(expanded)}, {"sources", sources}};
}

Json SpreadJson(const Spread& spread, const std::vector<Budget>& budgets, int trials) {
  Json json = {{"name", spread.quantity.name},
               {"mean", spread.mean},
               {"u", spread.sd},
               {"symmetric95", spread.symmetric},
               {"shortest95", spread.shortest}};
  const auto budget = std::ranges::find(budgets, spread.quantity.name,
                                        [](const Budget& b) -> const auto& { return b.quantity.name; });
  if (budget == budgets.end()) return json;
  const uncertainty::Agreement a = Compare(*budget, spread, trials);
  json["gum"] = {{"verdict", VerdictName(a.verdict)},
                 {"tolerance", a.tolerance},
                 {"d_low", a.d_low},
                 {"d_high", a.d_high}};
  return json;
}

constexpr Eigen::Index kMostRows = 400;  // of a matrix in a file

Json MatrixJson(const Eigen::MatrixXd& matrix) {
  Json rows = Json::array();
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    const Eigen::VectorXd row = matrix.row(i);
    rows.push_back(std::vector<double>(row.begin(), row.end()));
  }
  return rows;
}

Json JointJson(const uncertainty::Joint& joint) {
  Json json = {{"name", joint.name}, {"quantities", joint.names}};
  if (joint.cov.rows() > kMostRows) return json;
  json["covariance"] = MatrixJson(joint.cov);
  json["correlation"] = MatrixJson(uncertainty::CorrelationOf(joint.cov));
  return json;
}

Json JointsJson(const std::vector<uncertainty::Joint>& joints) {
  Json all = Json::array();
  for (const uncertainty::Joint& joint : joints) all.push_back(JointJson(joint));
  return all;
}

Json SpreadTogetherJson(const uncertainty::JointSpread& spread) {
  Json json = JointJson(spread.joint);
  json["region95"] = {{"dimensions", spread.region.dimensions},
                      {"ellipsoid_k", NumberOrNull(spread.region.ellipsoid_k)},
                      {"ellipsoid_k_gum", spread.region.ellipsoid_gum_k},
                      {"rectangle_k", spread.region.rectangle_k}};
  return json;
}

Json SourceJson(const Source& source, const std::string& unit) {
  Json json = {{"source", source.name},
               {"type", std::string(1, source.type)},
               {"u", source.u},
               {"dof", NumberOrNull(source.dof)}};
  if (uncertainty::IsOfReadings(source)) return json;
  json["u_input"] = source.u_input;
  json["input_unit"] = source.input_unit;
  json["sensitivity"] = source.sensitivity;
  json["sensitivity_unit"] = SensitivityUnit(unit, source.input_unit);
  return json;
}

Json BudgetOf(const Budget& budget) {
  const std::string unit = uncertainty::UnitOf(budget.quantity.name);
  Json sources = Json::array();
  for (const Source& source : budget.sources) sources.push_back(SourceJson(source, unit));
  return {{"name", budget.quantity.name},
          {"value", budget.quantity.value},
          {"unit", unit},
          {"u", budget.u},
          {"dof", NumberOrNull(budget.dof)},
          {"k", budget.k},
          {"U", budget.Expanded()},
          {"sources", sources}};
}

}  // namespace

Json BudgetJson(const std::vector<Budget>& budgets, const std::vector<uncertainty::Joint>& joints,
                const MonteCarlo* trials) {
  Json all = Json::array();
  for (const Budget& budget : budgets) all.push_back(BudgetOf(budget));
  Json json = {{"coverage_probability", 0.95},
               {"uncertainty", all},
               {"not_counted", uncertainty::SourcesOfNothing(budgets)},
               {"covariance", JointsJson(joints)}};
  if (!trials) return json;
  Json spreads = Json::array();
  for (const Spread& spread : trials->spreads) spreads.push_back(SpreadJson(spread, budgets, trials->trials));
  Json together = Json::array();
  for (const uncertainty::JointSpread& spread : trials->together) together.push_back(SpreadTogetherJson(spread));
  json["monte_carlo"] = {{"trials", trials->trials},
                         {"settled", trials->settled},
                         {"quantities", spreads},
                         {"covariance", together}};
  return json;
}

Json BudgetsByList(const std::vector<Budget>& budgets) {
  Json json = Json::array();
  for (const QuantityList& group : ListsAmong(budgets)) json.push_back(ListJson(group));
  return json;
}

}  // namespace twinbench::report
