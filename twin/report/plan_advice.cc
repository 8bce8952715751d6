#include "twin/report/plan_advice.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "twin/report/text_table.h"

namespace twinbench::report {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kAdviceWidth = 118;

Json FiniteOrNull(double x) {
  return std::isfinite(x) ? Json(x) : Json();
}

std::string SetLines(const plan::NextRun& run) {
  return fmt::format("{}", fmt::join(run.sets, "\n"));
}

/// The geometric mean over kinds of results.
std::string RatioText(const plan::Advice& one) {
  return one.gains.empty() ? "" : fmt::format("{:.2f}", std::exp2(-one.of_results_bit));
}

/// The first few, and how many more.
std::string FirstOf(const std::vector<std::string>& names) {
  constexpr std::size_t kMostListed = 2;
  std::string lines;
  for (std::size_t k = 0; k < std::min(kMostListed, names.size()); ++k) lines += "\n  " + names[k];
  if (names.size() > kMostListed) lines += fmt::format("\n  and {} more", names.size() - kMostListed);
  return lines;
}

std::string BoughtLines(const plan::Advice& one) {
  std::string lines = one.run.words;
  if (!one.mended.empty()) lines += "\nseparates" + FirstOf(one.mended);
  if (!one.broken.empty()) lines += fmt::format("\ndistinguishes {} pair{}", one.broken.size(), one.broken.size() == 1 ? "" : "s") + FirstOf(one.broken);
  if (!one.shown.empty()) lines += fmt::format("\nresolves {} further cause{}", one.shown.size(), one.shown.size() == 1 ? "" : "s") + FirstOf(one.shown);
  return lines;
}

/// What it adds, the separation's own first; nothing has an uncertainty where no reading is more than the unknowns are.
std::string CertainLines(const Mending& one) {
  constexpr std::size_t kMostListed = 4;
  if (one.certain.empty()) return one.dof > 0.0 ? "" : "no u: no degrees of freedom are left";
  std::vector<plan::Gain> certain = one.certain;
  std::stable_partition(certain.begin(), certain.end(), [](const plan::Gain& result) { return result.name.starts_with("separation."); });
  std::string lines;
  for (std::size_t k = 0; k < std::min(kMostListed, certain.size()); ++k)
    lines += fmt::format("{}u({}) = {:.3g}", lines.empty() ? "" : "\n", certain[k].name, certain[k].ratio);
  if (certain.size() > kMostListed) lines += fmt::format("\nand {} more", certain.size() - kMostListed);
  return lines;
}

std::string OfCausesText(const plan::Advice& one) {
  return one.IsWhole() ? fmt::format("{:.1f}", one.of_causes_bit) : one.causes_unknown;
}

/// Under a table in which some run is not known whole.
constexpr const char* kResultsAlone = "Here the rate is of results alone: what some runs tell of causes is not known.\n";

Json RunJson(const plan::NextRun& run) {
  return {{"name", run.name}, {"words", run.words}, {"sets", run.sets}};
}

Json GainsJson(const std::vector<plan::Gain>& gains, const char* what) {
  Json list = Json::array();
  for (const plan::Gain& gain : gains) list.push_back({{"name", gain.name}, {what, gain.ratio}});
  return list;
}

Json TimesJson(const PlannedProgramme& programme, const plan::Programme& of) {
  Json runs = Json::array();
  for (std::size_t j = 0; j < programme.runs.size(); ++j) {
    if (of.times[j] == 0) continue;
    Json run = RunJson(programme.runs[j].run);
    run["times"] = of.times[j];
    runs.push_back(std::move(run));
  }
  return {{"runs", runs},
          {"cost", of.cost},
          {"criterion", of.criterion},
          {"bound", of.bound},
          {"efficiency", of.efficiency},
          {"every_programme_looked_at", of.exhaustive}};
}

std::string RunsOf(const PlannedProgramme& programme, const plan::Programme& of) {
  std::string text;
  for (std::size_t j = 0; j < programme.runs.size(); ++j) {
    if (of.times[j] > 0)
      text += fmt::format("{}{} x {}", text.empty() ? "" : ", ", of.times[j], programme.runs[j].run.name);
  }
  return text.empty() ? "nothing fits" : text;
}

std::vector<std::string> ProgrammeRow(const char* name, const PlannedProgramme& programme, const plan::Programme& of) {
  return {name, RunsOf(programme, of), programme.budget.in_readings ? fmt::format("{:.0f}", of.cost) : MinutesText(of.cost), fmt::format("{:.1f} %", 100.0 * of.efficiency),
          of.exhaustive ? "all" : "by exchange"};
}

}  // namespace

std::string MinutesText(double minutes) {
  constexpr double kWhole_min = 10.0;
  return std::abs(minutes) < kWhole_min ? fmt::format("{:.2g}", minutes) : fmt::format("{:.0f}", minutes);
}

std::string MendingText(const std::vector<Mending>& mendings) {
  constexpr std::size_t kMostShown = 6;
  std::vector<std::vector<std::string>> rows;
  for (const Mending& one : mendings) {
    if (rows.size() == kMostShown) break;
    rows.push_back({one.run.words + "\n" + SetLines(one.run), fmt::format("{:+.0f}", one.more_minutes),
                    fmt::format("{}", fmt::join(one.words, "\n")), CertainLines(one)});
  }
  const std::string table =
      TextTable({{"what would separate it"}, {"minutes more", true}, {"separates"}, {"how certain it gets"}}, rows,
                kAdviceWidth);
  const bool are_more = mendings.size() > kMostShown;
  return table + (are_more ? fmt::format("and {} more, all in the JSON\n", mendings.size() - kMostShown) : "");
}

Json MendingJson(const std::vector<Mending>& mendings) {
  Json list = Json::array();
  for (const Mending& one : mendings) {
    Json entry = RunJson(one.run);
    entry["minutes"] = one.minutes;
    entry["more_minutes"] = one.more_minutes;
    entry["separates"] = one.mended;
    entry["results"] = GainsJson(one.certain, "rms_u");
    list.push_back(std::move(entry));
  }
  return list;
}

std::string PlanAdviceText(const std::vector<plan::Advice>& advice) {
  std::vector<std::vector<std::string>> rows;
  for (const plan::Advice& one : advice)
    rows.push_back({one.run.name, BoughtLines(one), fmt::format("{}", one.readings), MinutesText(one.minutes), RatioText(one),
                    OfCausesText(one), fmt::format("{:.3f}", plan::RateOf(one, advice))});
  const std::string table = TextTable({{"another run"},
                                       {"what it is and buys"},
                                       {"readings", true},
                                       {"minutes", true},
                                       {"u after/before", true},
                                       {"causes [bit]", true},
                                       {"rate [bit/min]", true}},
                                      rows, kAdviceWidth);
  return table + "causes: information about their sizes; rate: information rate, of results and causes\n" +
         (std::ranges::all_of(advice, &plan::Advice::IsWhole) ? "" : kResultsAlone);
}

Json PlanAdviceJson(const std::vector<plan::Advice>& advice) {
  Json list = Json::array();
  for (const plan::Advice& one : advice) {
    Json entry = RunJson(one.run);
    entry["readings"] = one.readings;
    entry["minutes"] = one.minutes;
    entry["u_after_over_before"] = GainsJson(one.gains, "ratio");
    entry["separates"] = one.mended;
    entry["tells_apart"] = one.broken;
    entry["shows"] = one.shown;
    entry["of_results_bit"] = one.of_results_bit;
    entry["of_causes_bit"] = one.IsWhole() ? Json(one.of_causes_bit) : Json();
    entry["closest_causes_sigma"] = FiniteOrNull(one.closest);
    entry["bit_per_minute"] = plan::RateOf(one, advice);
    list.push_back(std::move(entry));
  }
  return list;
}

std::string ProgrammeText(const PlannedProgramme& programme) {
  const std::string unit = programme.budget.in_readings ? "readings" : "minutes";
  return fmt::format("Beside the scenario's own run, within {:.0f} {}{}:\n", programme.budget.amount, unit,
                     programme.is_of_results_alone ? ", by results alone (what some runs tell of causes is not known)" : "") +
         TextTable({{""}, {"runs"}, {unit, true}, {"efficiency at least", true}, {"looked at"}},
                   {ProgrammeRow("D-optimal", programme, programme.best),
                    ProgrammeRow("A-optimal", programme, programme.least_trace)},
                   kAdviceWidth);
}

Json ProgrammeJson(const PlannedProgramme& programme) {
  return {{"budget", programme.budget.amount},
          {"in", programme.budget.in_readings ? "readings" : "minutes"},
          {"unknowns", programme.unknowns},
          {"by_results_alone", programme.is_of_results_alone},
          {"u_after_over_before", GainsJson(programme.gains, "ratio")},
          {"d_optimal", TimesJson(programme, programme.best)},
          {"a_optimal", TimesJson(programme, programme.least_trace)}};
}

}  // namespace twinbench::report
