#include "twin/report/uncertainty_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>

#include "twin/report/spoken_keys.h"
#include "twin/report/text_table.h"
#include "twin/uncertainty/agreement.h"

namespace twinbench::report {
namespace {

using uncertainty::Budget;
using uncertainty::MonteCarlo;
using uncertainty::OneAtATime;
using uncertainty::Source;
using uncertainty::Spread;

constexpr std::size_t kBudgetWidth = 100;
using Rows = std::vector<std::vector<std::string>>;
using Json = nlohmann::json;

/// Budgets of one kind of result, in the order of the results.
struct QuantityList {
  std::string name;
  std::vector<const Budget*> budgets;
};

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

template <class Of>
double RootMeanSquare(const QuantityList& group, Of of) {
  double sum = 0.0;
  for (const Budget* budget : group.budgets) sum += of(*budget) * of(*budget);
  return std::sqrt(sum / static_cast<double>(group.budgets.size()));
}

double OfSource(const Budget& budget, const std::string& name) {
  const auto found = std::ranges::find(budget.sources, name, &Source::name);
  return found == budget.sources.end() ? 0.0 : found->u;
}

std::string DofText(double dof) {
  return std::isfinite(dof) ? fmt::format("{:.0f}", dof) : "inf";
}

/// Of the value of a list that has fewest.
double FewestDof(const QuantityList& group) {
  double fewest = std::numeric_limits<double>::infinity();
  for (const Budget* budget : group.budgets) fewest = std::min(fewest, budget->dof);
  return fewest;
}

/// One source over a list: root mean square of what it adds.
struct ListSource {
  const Source* source = nullptr;
  double u = 0.0;
  double share = 0.0;  // of u^2
};

/// Largest first.
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

/// "0.02 nm"; empty of what the readings leave.
std::string InputText(const Source& source) {
  if (uncertainty::IsOfReadings(source)) return "";
  return fmt::format("{:.3g}{}{}", source.u_input, source.input_unit.empty() ? "" : " ", source.input_unit);
}

/// "arcsec/nm"
std::string SensitivityUnit(const std::string& unit, const std::string& input_unit) {
  if (input_unit.empty()) return unit;
  return (unit.empty() ? "1" : unit) + "/" + input_unit;
}

std::string SensitivityText(const ListSource& s, const std::string& unit) {
  if (uncertainty::IsOfReadings(*s.source)) return "";
  const std::string words = SensitivityUnit(unit, s.source->input_unit);
  return fmt::format("{:.3g}{}{}", s.u / s.source->u_input, words.empty() ? "" : " ", words);
}

std::string SourcesTable(const QuantityList& group) {
  Rows rows;
  for (const ListSource& s : SourcesOf(group)) {
    rows.push_back({WithWords(s.source->name), std::string(1, s.source->type), InputText(*s.source),
                    SensitivityText(s, uncertainty::UnitOf(group.name)), fmt::format("{:.3g}", s.u),
                    DofText(s.source->dof), fmt::format("{:.1f} %", 100.0 * s.share)});
  }
  return TextTable({{"source"},
                    {"type"},
                    {"u(x)", true},
                    {"|c|", true},
                    {"u", true},
                    {"dof", true},
                    {"share of u^2", true}},
                   rows, kBudgetWidth);
}

const Budget* BudgetNamed(const std::vector<const Budget*>& budgets, const std::string& name) {
  const auto found = std::ranges::find(budgets, name, [](const Budget* b) -> const auto& { return b->quantity.name; });
  return found == budgets.end() ? nullptr : *found;
}

/// How many intervals of a list are those of the trials, and how many are not.
std::string AgreementText(const std::map<uncertainty::Verdict, int>& count) {
  const auto of = [&](uncertainty::Verdict v) { return count.contains(v) ? count.at(v) : 0; };
  const int agree = of(uncertainty::Verdict::kAgree), differ = of(uncertainty::Verdict::kDiffer),
            open = of(uncertainty::Verdict::kTooFewTrials);
  if (differ > 0)
    return fmt::format("GUM AND TRIALS DIFFER in {} of {}: take the trials' interval\n", differ,
                       agree + differ + open);
  return open > 0 ? fmt::format("whether GUM and trials agree takes more of them to say, in {} of {}\n", open,
                                agree + open)
                  : "GUM and trials agree\n";
}

/// Root mean square of the trials' standard deviations over a list, and of half their shortest intervals; and
/// whether the budgets' intervals are theirs.
std::string TrialsText(const QuantityList& group, const MonteCarlo& trials) {
  double sd2 = 0.0, half2 = 0.0;
  int count = 0;
  std::array<double, 2> last = {};
  std::map<uncertainty::Verdict, int> verdicts;
  for (const Spread& spread : trials.spreads) {
    const Budget* budget = BudgetNamed(group.budgets, spread.quantity.name);
    if (!budget) continue;
    sd2 += spread.sd * spread.sd;
    half2 += 0.25 * std::pow(spread.shortest[1] - spread.shortest[0], 2);
    last = spread.shortest;
    ++verdicts[Compare(*budget, spread, trials.trials).verdict];
    ++count;
  }
  if (count == 0) return "";
  const std::string interval =
      count == 1 ? fmt::format("{:.4g} to {:.4g}", last[0], last[1])
                 : fmt::format("± {:.3g}", std::sqrt(half2 / count));
  return fmt::format("by trials: u = {:.3g}, shortest 95 % interval {}; {}", std::sqrt(sd2 / count), interval,
                     AgreementText(verdicts));
}

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

/// The largest correlation between two of them.
std::string JointText(const uncertainty::Joint& joint) {
  if (joint.names.size() < 2) return "";
  Eigen::MatrixXd correlation = uncertainty::CorrelationOf(joint.cov);
  correlation.diagonal().setZero();
  Eigen::Index i = 0, j = 0;
  correlation.cwiseAbs().maxCoeff(&i, &j);
  return fmt::format("{}: {} values are uncertain together; strongest correlation {:+.2f}, {} and {}\n", joint.name,
                     joint.names.size(), correlation(i, j), joint.names[static_cast<std::size_t>(i)],
                     joint.names[static_cast<std::size_t>(j)]);
}

std::string RegionText(const uncertainty::JointSpread& spread) {
  const uncertainty::Region& r = spread.region;
  std::string text = fmt::format("{}: 95 % of the trials have every value within {:.2f} u at once", spread.joint.name,
                                 r.rectangle_k);
  if (std::isfinite(r.ellipsoid_k))
    text += fmt::format(", and lie in the ellipsoid of k = {:.2f} in {} dimensions (GUM: {:.2f})", r.ellipsoid_k,
                        r.dimensions, r.ellipsoid_gum_k);
  return text + "\n";
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

/// Shares of one figure, first that without which least is left.
std::vector<const uncertainty::Share*> BySize(const OneAtATime& found, std::size_t figure) {
  std::vector<const uncertainty::Share*> shares;
  for (const uncertainty::Share& share : found.shares) shares.push_back(&share);
  std::ranges::stable_sort(shares, std::less<>(), [=](const auto* share) { return share->without[figure]; });
  return shares;
}

}  // namespace

std::string BudgetText(const std::vector<Budget>& budgets, const std::vector<uncertainty::Joint>& joints,
                       const MonteCarlo* trials) {
  std::string text;
  for (const QuantityList& group : ListsAmong(budgets)) {
    const double u = RootMeanSquare(group, [](const Budget& b) { return b.u; });
    const double expanded = RootMeanSquare(group, [](const Budget& b) { return b.Expanded(); });
    const std::string count =
        group.budgets.size() > 1 ? fmt::format(" ({} values, root mean squares)", group.budgets.size()) : "";
    text += fmt::format("{}{}: u = {:.3g}, expanded uncertainty U = {:.3g} (coverage factor k = {:.2f}, 95 %; {} "
                        "degrees of freedom)\n",
                        WithWords(group.name), count, u, expanded, u > 0.0 ? expanded / u : 0.0, DofText(FewestDof(group)));
    text += SourcesTable(group);
    if (trials) text += TrialsText(group, *trials);
    text += "\n";
  }
  for (const std::string& name : uncertainty::SourcesOfNothing(budgets))
    text += fmt::format(
        "NOT COUNTED: {}: no result is computed with it; what an error of it does to the readings is "
        "in no line above\n",
        name);
  for (const uncertainty::Joint& joint : joints) text += JointText(joint);
  if (!trials) return text;
  for (const uncertainty::JointSpread& spread : trials->together) text += RegionText(spread);
  return text + fmt::format("{} trials{}\n", trials->trials,
                        trials->settled ? "" : ", which is too few for two digits of every uncertainty");
}

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

std::string ContributionsText(const OneAtATime& found) {
  std::string text;
  for (std::size_t f = 0; f < found.total.size(); ++f) {
    const double total = found.total[f].value;
    text += fmt::format("{}: {:.3g}\n", found.total[f].name, total);
    Rows rows;
    for (const uncertainty::Share* share : BySize(found, f)) {
      rows.push_back({share->contribution, share->alone.empty() ? "" : fmt::format("{:.3g}", share->alone[f]),
                      fmt::format("{:.3g}", share->without[f]),
                      fmt::format("{:.1f} %", 100.0 * (1.0 - std::pow(share->without[f] / total, 2)))});
    }
    rows.push_back({"electronics and light alone", fmt::format("{:.3g}", found.none[f]), "", ""});
    text += TextTable({{"source"}, {"alone", true}, {"switched off", true}, {"variance contribution", true}},
                      rows, kBudgetWidth);
    text += fmt::format("in quadrature: {:.3g}\n\n", found.InQuadrature(f));
  }
  return text;
}

Json ContributionsJson(const OneAtATime& found) {
  Json figures = Json::array();
  for (std::size_t f = 0; f < found.total.size(); ++f) {
    Json shares = Json::array();
    for (const uncertainty::Share& share : found.shares)
      shares.push_back({{"contribution", share.contribution},
                        {"alone", share.alone.empty() ? Json() : Json(share.alone[f])},
                        {"without", share.without[f]}});
    figures.push_back({{"name", found.total[f].name},
                       {"total", found.total[f].value},
                       {"none", found.none[f]},
                       {"in_quadrature", found.InQuadrature(f)},
                       {"contributions", shares}});
  }
  return {{"figures", figures}};
}

}  // namespace twinbench::report
