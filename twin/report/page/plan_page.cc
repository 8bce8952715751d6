#include "twin/report/page/plan_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "twin/report/page/causes.h"
#include "twin/report/page/named_numbers.h"

namespace twinbench::report {
namespace {

using nlohmann::json;

std::string Short(double value) {
  return std::isfinite(value) ? fmt::format("{:.3g}", value) : "";
}

PageTable RunsTable(const json& plan) {
  PageTable table{
      "Runs",
      {"run", "readings", "minutes", "degrees of freedom", "mean variance factor", "worst", "lower bound"},
      {}};
  for (const json& run : ListAt(plan, "runs")) {
    const json shifts = run.value("shifts", json::object());
    table.rows.push_back({TextAt(run, "run"), Short(NumberAt(run, "readings")), Short(NumberAt(run, "minutes")),
                          NumberText(NumberAt(run, "dof")), Short(NumberAt(shifts, "mean_variance_factor")),
                          Short(NumberAt(shifts, "worst_variance_factor")),
                          Short(NumberAt(shifts, "least_possible_mean_factor"))});
  }
  return table;
}

/// A column more: u of the first run's results when the programme has been made after it.
void AddAfterProgramme(const json& plan, const json& after, PageTable& table) {
  table.columns.push_back("with the programme after it");
  for (auto& row : table.rows) row.emplace_back();
  for (const json& result : ListAt(plan.at("runs").front(), "results")) {
    const std::string words = PathInWords(NameAndUnit(TextAt(result, "name")).name);
    double ratio = 1.0;
    for (const json& gain : after)
      if (TextAt(gain, "name") == TextAt(result, "name")) ratio = NumberAt(gain, "ratio");
    for (auto& row : table.rows)
      if (row[0] == words) row.back() = Short(ratio * NumberAt(result, "rms_u"));
  }
}

/// u of every result in every run.
PageTable PlannedResults(const json& plan) {
  PageTable table{"Standard uncertainty (rms)", {"result", "unit"}, {}};
  for (const json& run : ListAt(plan, "runs")) {
    table.columns.push_back(TextAt(run, "run"));
    for (const json& result : ListAt(run, "results")) {
      const auto [name, unit] = NameAndUnit(TextAt(result, "name"));
      const std::string words = PathInWords(name);
      auto row = std::find_if(table.rows.begin(), table.rows.end(), [&](const auto& r) { return r[0] == words; });
      if (row == table.rows.end()) row = table.rows.insert(row, {words, unit});
      row->resize(table.columns.size());
      row->back() = Short(NumberAt(result, "rms_u"));
    }
  }
  for (auto& row : table.rows) row.resize(table.columns.size());
  const json after = ListAt(plan.value("programme", json::object()), "u_after_over_before");
  if (!after.empty()) AddAfterProgramme(plan, after, table);
  return table;
}

/// "2 x wide-sweep, 1 x warming"
std::string ProgrammeInWords(const json& plan) {
  std::string words;
  for (const json& run : ListAt(plan.value("programme", json::object()).value("d_optimal", json::object()), "runs"))
    words += fmt::format("{}{:g} x {}", words.empty() ? "" : ", ", NumberAt(run, "times"), TextAt(run, "name"));
  return words;
}

/// u against the order, a figure a result, a series a run.
std::vector<Figure> OrderFigures(const json& plan) {
  std::vector<Figure> figures;
  for (const json& run : ListAt(plan, "runs")) {
    for (const json& result : ListAt(run, "harmonics")) {
      const auto order = NumbersAt(result, "order"), u = NumbersAt(result, "u");
      if (!order || !u || order->size() != u->size()) continue;
      const auto [name, unit] = NameAndUnit(TextAt(result, "name"));
      const std::string title = "u of " + PathInWords(name);
      auto figure = std::find_if(figures.begin(), figures.end(), [&](const Figure& f) { return f.title == title; });
      if (figure == figures.end())
        figure = figures.insert(figure,
                                {FigureForm::kBars, title, "", {"order", ""}, {"standard uncertainty", unit}, {}});
      figure->series.push_back({TextAt(run, "run"), SeriesRole::kEstimate, *order, *u, {}});
    }
  }
  return figures;
}

Figure AdviceFigure(const json& plan) {
  Figure figure{FigureForm::kRanks, "Information rate of each next run", "about causes and results together",
                {"", ""},           {"information", "bit/minute"},       {}};
  FigureSeries bars{"information", SeriesRole::kEstimate, {}, {}, {}};
  for (const json& run : ListAt(plan, "advice")) {
    figure.categories.push_back(TextAt(run, "words"));
    bars.y.push_back(NumberAt(run, "bit_per_minute"));
  }
  if (!bars.y.empty()) figure.series.push_back(bars);
  return figure;
}

PageTable AdviceTable(const json& plan) {
  PageTable table{"Runs that could be made next",
                  {"run", "minutes", "readings", "information about causes [bit]", "about results [bit]", "keys"},
                  {}};
  for (const json& run : ListAt(plan, "advice")) {
    std::string keys;
    for (const json& key : ListAt(run, "sets"))
      keys += (keys.empty() ? "" : "  ") + (key.is_string() ? key.get<std::string>() : "");
    table.rows.push_back({TextAt(run, "words"), Short(NumberAt(run, "minutes")), Short(NumberAt(run, "readings")),
                          Short(NumberAt(run, "of_causes_bit")), Short(NumberAt(run, "of_results_bit")), keys});
  }
  return table;
}

PageTable PlannedTies(const json& plan) {
  PageTable table{"What may be mistaken for another cause",
                  {"present", "may be identified instead", "distinguished above", "unit"},
                  {}};
  for (const json& tie : ListAt(plan, "ties"))
    table.rows.push_back({NameOfCause(tie.value("present", json())), NameOfCause(tie.value("blamed", json())),
                          Short(NumberAt(tie, "told_from")), UnitText(TextAt(tie, "unit"))});
  return table;
}

PageTable NeverToldApart(const json& plan) {
  PageTable table{"Indistinguishable at any size (aliased)", {"causes"}, {}};
  for (const json& group : ListAt(plan, "never_told_apart")) {
    std::string names;
    for (const json& cause : group) names += (names.empty() ? "" : ", ") + NameOfCause(cause);
    table.rows.push_back({names});
  }
  return table;
}

PageTable PlannedLosses(const json& plan) {
  PageTable table{"Not separable by these designs", {"run", "what"}, {}};
  for (const json& run : ListAt(plan, "runs")) {
    for (const json& lost : ListAt(run, "not_separable"))
      if (lost.is_string()) table.rows.push_back({TextAt(run, "run"), lost.get<std::string>()});
  }
  return table;
}

}  // namespace

Page PlanPage(const PageSource& source, const json& plan) {
  const std::string title = TextAt(plan, "title");
  Page page{title.empty() ? source.name : title,
            "plan: nothing has been measured, this is what runs would give",
            "",
            VerdictTone::kPlain,
            {}};
  for (const json& run : ListAt(plan, "advice")) {
    if (TextAt(run, "name") == TextAt(plan, "next"))
      page.verdict = "Most information per minute: " + TextAt(run, "words") + ".";
  }
  if (const std::string programme = ProgrammeInWords(plan); !programme.empty())
    page.verdict = "Best runs to add: " + programme + ". " + page.verdict;
  PageSection runs{"Runs", "", {}}, next{"Next run", "", {}}, sight{"Detectability", "", {}};
  AddFilled(PlannedResults(plan), runs);
  AddFilled(RunsTable(plan), runs);
  for (Figure& figure : OrderFigures(plan)) runs.blocks.emplace_back(std::move(figure));
  AddFilled(PlannedLosses(plan), runs);
  if (Figure advice = AdviceFigure(plan); !advice.series.empty()) next.blocks.emplace_back(std::move(advice));
  AddFilled(AdviceTable(plan), next);
  AddFilled(DetectableTable(plan), sight);
  AddFilled(PlannedTies(plan), sight);
  AddFilled(NeverToldApart(plan), sight);
  AddFilled(InvisibleTable(plan), sight);
  for (PageSection* section : {&runs, &next, &sight}) {
    if (!section->blocks.empty()) page.sections.push_back(std::move(*section));
  }
  page.sections.push_back(ProvenanceSection(source));
  return page;
}

}  // namespace twinbench::report
