#include "twin/report/uncertainty_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>

#include "twin/report/text_table.h"

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
  for (const auto& [name, source] : sources) {
    const double size = RootMeanSquare(group, [&](const Budget& b) { return OfSource(b, name); });
    by_size.push_back({source, size, u > 0.0 ? size * size / (u * u) : 0.0});
  }
  std::ranges::sort(by_size, std::greater<>(), &ListSource::u);
  return by_size;
}

std::string SourcesTable(const QuantityList& group) {
  Rows rows;
  for (const ListSource& s : SourcesOf(group)) {
    rows.push_back({s.source->name, std::string(1, s.source->type), fmt::format("{:.3g}", s.u),
                    DofText(s.source->dof), fmt::format("{:.1f} %", 100.0 * s.share)});
  }
  return TextTable({{"source"}, {"type"}, {"u", true}, {"dof", true}, {"share of u^2", true}}, rows, kBudgetWidth);
}

/// Root mean square of the trials' standard deviations over a list, and of half their shortest intervals.
std::string TrialsText(const QuantityList& group, const MonteCarlo& trials) {
  double sd2 = 0.0, half2 = 0.0;
  int count = 0;
  for (const Spread& spread : trials.spreads) {
    if (uncertainty::KindOf(spread.quantity.name) != group.name) continue;
    sd2 += spread.sd * spread.sd;
    half2 += 0.25 * std::pow(spread.shortest[1] - spread.shortest[0], 2);
    ++count;
  }
  if (count == 0) return "";
  return fmt::format("by trials: u = {:.3g}, shortest 95 % interval +- {:.3g}\n", std::sqrt(sd2 / count),
                     std::sqrt(half2 / count));
}

Json NumberOrNull(double value) {
  return std::isfinite(value) ? Json(value) : Json();
}

Json ListJson(const QuantityList& group) {
  const double u = RootMeanSquare(group, [](const Budget& b) { return b.u; });
  const double expanded = RootMeanSquare(group, [](const Budget& b) { return b.Expanded(); });
  Json sources = Json::array();
  for (const ListSource& s : SourcesOf(group))
    sources.push_back({{"source", s.source->name},
                       {"type", std::string(1, s.source->type)},
                       {"u", NumberOrNull(s.u)},
                       {"dof", NumberOrNull(s.source->dof)},
                       {"share", NumberOrNull(s.share)}});
  return {{"name", group.name},          {"values", group.budgets.size()},
          {"u", NumberOrNull(u)},        {"k", NumberOrNull(expanded / u)},
          {"U", NumberOrNull(expanded)}, {"sources", sources}};
}

Json SpreadJson(const Spread& spread) {
  return {{"name", spread.quantity.name},
          {"mean", spread.mean},
          {"u", spread.sd},
          {"symmetric95", spread.symmetric},
          {"shortest95", spread.shortest}};
}

Json BudgetOf(const Budget& budget) {
  Json sources = Json::array();
  for (const Source& source : budget.sources)
    sources.push_back({{"source", source.name},
                       {"type", std::string(1, source.type)},
                       {"u", source.u},
                       {"dof", NumberOrNull(source.dof)}});
  return {{"name", budget.quantity.name},
          {"value", budget.quantity.value},
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

std::string BudgetText(const std::vector<Budget>& budgets, const MonteCarlo* trials) {
  std::string text;
  for (const QuantityList& group : ListsAmong(budgets)) {
    const double u = RootMeanSquare(group, [](const Budget& b) { return b.u; });
    const double expanded = RootMeanSquare(group, [](const Budget& b) { return b.Expanded(); });
    const std::string count =
        group.budgets.size() > 1 ? fmt::format(" ({} values, root mean squares)", group.budgets.size()) : "";
    text += fmt::format("{}{}: u = {:.3g}, U = {:.3g} (k = {:.2f}, 95 %)\n", group.name, count, u, expanded,
                        u > 0.0 ? expanded / u : 0.0);
    text += SourcesTable(group);
    if (trials) text += TrialsText(group, *trials);
    text += "\n";
  }
  for (const std::string& name : uncertainty::SourcesOfNothing(budgets))
    text += fmt::format(
        "NOT COUNTED: {}: no result is computed with it; what an error of it does to the readings is "
        "in no line above\n",
        name);
  if (trials)
    text += fmt::format("{} trials{}\n", trials->trials,
                        trials->settled ? "" : ", which is too few for two digits of every uncertainty");
  return text;
}

Json BudgetJson(const std::vector<Budget>& budgets, const MonteCarlo* trials) {
  Json all = Json::array();
  for (const Budget& budget : budgets) all.push_back(BudgetOf(budget));
  Json json = {{"uncertainty", all}, {"not_counted", uncertainty::SourcesOfNothing(budgets)}};
  if (!trials) return json;
  Json spreads = Json::array();
  for (const Spread& spread : trials->spreads) spreads.push_back(SpreadJson(spread));
  json["monte_carlo"] = {{"trials", trials->trials}, {"settled", trials->settled}, {"quantities", spreads}};
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
    text += TextTable({{"contribution"}, {"alone", true}, {"without it", true}, {"share of the square", true}},
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
