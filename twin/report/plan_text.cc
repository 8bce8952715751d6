#include "twin/report/plan_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "twin/report/diagnosis_tables.h"
#include "twin/report/text_table.h"

namespace twinbench::report {
namespace {

using plan::Certainty;
using plan::Outlook;
using plan::ShiftSet;
using Json = nlohmann::json;

constexpr std::size_t kPlanWidth = 100;

std::string DegreesOfFreedom(double dof) {
  return std::isfinite(dof) ? fmt::format("{:.0f}", dof) : "";
}

std::string FactorText(double factor) {
  return std::isfinite(factor) ? fmt::format("{:.3f}", factor) : "infinite";
}

double UncertaintyOf(const Outlook& outlook, const std::string& name) {
  const auto found = std::ranges::find(outlook.results, name, &Certainty::name);
  return found == outlook.results.end() ? std::nan("") : found->rms_u;
}

std::string RunsTable(const std::vector<PlannedRun>& runs) {
  std::vector<std::vector<std::string>> rows;
  for (const PlannedRun& run : runs)
    rows.push_back({run.words, fmt::format("{}", run.outlook.readings), fmt::format("{:.0f}", run.outlook.minutes),
                    DegreesOfFreedom(run.outlook.dof), run.shifts ? FactorText(run.shifts->mean_factor) : "",
                    run.shifts ? FactorText(run.shifts->worst_factor) : "",
                    run.shifts && !run.shifts->lost.empty() ? ShiftList(run.shifts->lost) : ""});
  return TextTable({{"run"},
                    {"readings", true},
                    {"minutes", true},
                    {"dof left", true},
                    {"variance, mean", true},
                    {"worst", true},
                    {"harmonics lost"}},
                   rows, kPlanWidth);
}

/// A row a result, a column a run.
std::string CertaintyTable(const std::vector<PlannedRun>& runs) {
  std::vector<TextColumn> columns = {{"standard uncertainty (rms)"}};
  for (std::size_t i = 0; i < runs.size(); ++i) columns.push_back({fmt::format("run {}", i + 1), true});
  std::vector<std::vector<std::string>> rows;
  for (const Certainty& result : runs.front().outlook.results) {
    std::vector<std::string> row = {result.name};
    for (const PlannedRun& run : runs) {
      const double u = UncertaintyOf(run.outlook, result.name);
      row.push_back(std::isfinite(u) ? fmt::format("{:.3g}", u) : "-");
    }
    rows.push_back(std::move(row));
  }
  return TextTable(columns, rows, kPlanWidth);
}

Json OutlookJson(const PlannedRun& run) {
  Json results = Json::array();
  for (const Certainty& result : run.outlook.results)
    results.push_back(
        {{"name", result.name}, {"values", result.values}, {"rms_u", result.rms_u}, {"worst_u", result.worst_u}});
  Json json = {{"run", run.words},
               {"readings", run.outlook.readings},
               {"minutes", run.outlook.minutes},
               {"dof", std::isfinite(run.outlook.dof) ? Json(run.outlook.dof) : Json()},
               {"results", results},
               {"not_separable", run.outlook.not_separable}};
  if (!run.shifts) return json;
  const auto number = [](double x) { return std::isfinite(x) ? Json(x) : Json(); };
  json["shifts"] = {{"shifts", run.shifts->shifts},
                    {"mean_variance_factor", number(run.shifts->mean_factor)},
                    {"worst_variance_factor", number(run.shifts->worst_factor)},
                    {"lost_harmonics", run.shifts->lost},
                    {"every_set_looked_at", run.shifts->exhaustive}};
  return json;
}

}  // namespace

std::string ShiftList(const std::vector<int>& shifts) {
  return fmt::format("{}", fmt::join(shifts, ", "));
}

std::string PlanText(const std::vector<PlannedRun>& runs, const diagnose::Diagnosis& seen) {
  std::string text = RunsTable(runs);
  const bool shifted = std::ranges::any_of(runs, [](const PlannedRun& run) { return run.shifts.has_value(); });
  if (shifted)
    text += "variance: of one table's harmonic over that of the mean of all set-ups; no set of shifts is below 1\n";
  text += "\n" + CertaintyTable(runs) + "\n";
  for (const std::string& lost : runs.front().outlook.not_separable)
    text += Paragraph("Not separable: ", lost, 4, kPlanWidth);
  return text + "\n" + DetectableTable(seen) + "\n" + InvisibleTable(seen);
}

Json PlanJson(const std::vector<PlannedRun>& runs, const diagnose::Diagnosis& seen) {
  Json json = {{"runs", Json::array()}, {"detectable", Json::array()}, {"invisible", Json::array()}};
  for (const PlannedRun& run : runs) json["runs"].push_back(OutlookJson(run));
  for (const diagnose::Detectable& one : seen.detectable) {
    if (std::isfinite(one.smallest.value))
      json["detectable"].push_back({{"effect", one.effect},
                                    {"where", one.where},
                                    {"parameter", one.smallest.name},
                                    {"unit", one.smallest.unit},
                                    {"smallest", one.smallest.value / one.smallest.to_SI}});
  }
  for (const diagnose::Invisible& one : seen.invisible)
    json["invisible"].push_back({{"effect", one.effect}, {"where", one.where}, {"could_bias", one.could_bias}});
  return json;
}

}  // namespace twinbench::report
