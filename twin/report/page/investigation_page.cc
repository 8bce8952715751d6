#include "twin/report/page/investigation_page.h"

#include <fmt/format.h>

#include <cctype>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "twin/report/page/causes.h"
#include "twin/report/page/named_numbers.h"

namespace twinbench::report {
namespace {

using nlohmann::json;

constexpr const char* kUnlisted = "not in the catalogue";

/// Probabilities of every hypothesis over the steps.
Figure BeliefFigure(const json& steps) {
  Figure figure{FigureForm::kLine, "Probability of each hypothesis", "probability after each run", {"run", ""}, {"probability", "", 0.0, 1.0}, {}};
  std::map<std::string, FigureSeries> beliefs;
  const auto add = [&](const std::string& name, double number, double probability) {
    FigureSeries& series = beliefs[name];
    series.name = name;
    series.x.push_back(number);
    series.y.push_back(probability);
  };
  for (const json& step : steps) {
    const double number = NumberAt(step, "number");
    for (const json& belief : ListAt(step, "believed")) add(TextAt(belief, "name"), number, NumberAt(belief, "probability"));
    if (NumberAt(step, "unlisted") > 0.0) add(kUnlisted, number, NumberAt(step, "unlisted"));
  }
  for (auto& [name, series] : beliefs) figure.series.push_back(std::move(series));
  return figure;
}

Figure InformationFigure(const json& steps) {
  Figure figure{FigureForm::kBars, "Information from each run", "", {"run", ""}, {"information", "bit"}, {}};
  FigureSeries expected{"expected", SeriesRole::kBefore, {}, {}, {}}, gained{"gained", SeriesRole::kAfter, {}, {}, {}};
  for (const json& step : steps) {
    for (FigureSeries* series : {&expected, &gained}) series->x.push_back(NumberAt(step, "number"));
    expected.y.push_back(NumberAt(step, "expected_bit"));
    gained.y.push_back(NumberAt(step, "gained_bit"));
  }
  figure.series = {expected, gained};
  return figure;
}

/// The goal's uncertainty after every run that has one.
Figure GoalFigure(const json& investigation, const json& steps) {
  Figure figure{FigureForm::kLine, "The goal", "uncertainty after each run", {"run", ""}, {"u of the goal", ""}, {}};
  FigureSeries reached{"reached", SeriesRole::kEstimate, {}, {}, {}};
  for (const json& step : steps) {
    if (!std::isfinite(NumberAt(step, "u_goal"))) continue;
    reached.x.push_back(NumberAt(step, "number"));
    reached.y.push_back(NumberAt(step, "u_goal"));
  }
  if (reached.x.empty()) return figure;
  figure.series.push_back(reached);
  if (investigation.contains("goal") && investigation.at("goal").is_object()) {
    const json& goal = investigation.at("goal");
    figure.note = TextAt(goal, "text") + (goal.value("met", false) ? ", met" : ", not met");
  }
  return figure;
}

/// "Not resolvable on this bench: eccentricity 76 %, signal_offset 19 %".
std::string Ending(const json& investigation) {
  constexpr double kWorthSaying = 0.01;
  std::string names;
  for (const json& cause : ListAt(investigation, "causes")) {
    const double probability = NumberAt(cause, "probability");
    if (probability > kWorthSaying) names += fmt::format("{}{} {:.0f} %", names.empty() ? ": " : ", ", TextAt(cause, "name"), 100.0 * probability);
  }
  std::string ending = TextAt(investigation, "ended");
  if (ending == "told") ending = "cause identified";
  if (ending == "nothing more can be told") ending = "not resolvable on this bench";
  ending += names;
  if (!ending.empty()) ending[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(ending[0])));
  return ending;
}

PageTable StepTable(const json& steps, const std::vector<std::string>& links) {
  PageTable table{"Runs", {"run", "what", "why", "minutes", "bit expected", "bit gained"}, {}, links};
  for (const json& step : steps)
    table.rows.push_back({fmt::format("{:g}  {}", NumberAt(step, "number"), TextAt(step, "run")), TextAt(step, "words"), TextAt(step, "reason"),
                          fmt::format("{:.1f}", NumberAt(step, "minutes")), fmt::format("{:.2f}", NumberAt(step, "expected_bit")),
                          fmt::format("{:.2f}", NumberAt(step, "gained_bit"))});
  return table;
}

/// "width 0.00405 ± 0.00003°", of all causes of a hypothesis.
std::string SizesOf(const json& hypothesis) {
  std::string sizes;
  for (const json& effect : ListAt(hypothesis, "effects")) {
    const json parameters = effect.value("parameters", json::object());
    for (const auto& [key, value] : parameters.items()) {
      const double u = NumberAt(parameters, "u_" + key);
      if (!value.is_number() || !std::isfinite(u)) continue;  // what was not fitted is the catalogue's
      const auto [name, unit] = NameAndUnit(key);
      sizes += (sizes.empty() ? "" : ", ") + name + " " + MeasuredText(value.get<double>(), u, unit);
    }
  }
  return sizes;
}

PageTable HypothesisTable(const json& investigation) {
  PageTable table{"Hypotheses at the end", {"hypothesis", "size with u", "probability", "chi square"}, {}};
  for (const json& cause : ListAt(investigation, "causes"))
    table.rows.push_back({TextAt(cause, "name"), SizesOf(cause), Percent(NumberAt(cause, "probability")), fmt::format("{:.1f}", NumberAt(cause, "chi2"))});
  if (const double unlisted = NumberAt(investigation, "unlisted"); unlisted > 0.0) table.rows.push_back({kUnlisted, "", Percent(unlisted), ""});
  return table;
}

PageTable RefusedTable(const json& investigation) {
  PageTable table{"Runs that were not made", {"run"}, {}};
  for (const json& refused : ListAt(investigation, "refused")) table.rows.push_back({refused.is_string() ? refused.get<std::string>() : refused.dump()});
  return table;
}

/// What is most probable, with its size.
std::vector<PageTile> TilesOf(const json& investigation, VerdictTone tone) {
  const json causes = ListAt(investigation, "causes");
  if (causes.empty()) return {};
  return {{"Most probable", TextAt(causes[0], "name") + ", " + Percent(NumberAt(causes[0], "probability")), SizesOf(causes[0]), tone}};
}

}  // namespace

Page InvestigationPage(const PageSource& source, const json& investigation, const std::vector<std::string>& links) {
  const json steps = ListAt(investigation, "steps");
  Page page{source.name, fmt::format("investigation of {} runs, {:.0f} min", steps.size(), NumberAt(investigation, "minutes")), "", VerdictTone::kDoubt, {}};
  page.verdict = Ending(investigation);
  if (TextAt(investigation, "ended") == "told") page.tone = VerdictTone::kGood;
  page.tiles = TilesOf(investigation, page.tone);
  PageSection section{"Investigation", "", {}};
  section.blocks.emplace_back(BeliefFigure(steps));
  section.blocks.emplace_back(InformationFigure(steps));
  if (Figure goal = GoalFigure(investigation, steps); !goal.series.empty()) section.blocks.emplace_back(std::move(goal));
  AddFilled(StepTable(steps, links), section);
  AddFilled(HypothesisTable(investigation), section);
  AddFilled(RefusedTable(investigation), section);
  page.sections = {section, ProvenanceSection(source)};
  return page;
}

}  // namespace twinbench::report
