#include "twin/report/plan_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "twin/report/compensation_text.h"
#include "twin/report/not_separable_text.h"
#include "twin/report/spoken_keys.h"
#include "twin/report/text_table.h"

namespace twinbench::report {
namespace {

using plan::Certainty;
using plan::HarmonicCertainty;
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
    rows.push_back({run.words, fmt::format("{}", run.outlook.readings), MinutesText(run.outlook.minutes),
                    DegreesOfFreedom(run.outlook.dof), run.shifts ? FactorText(run.shifts->mean_factor) : "",
                    run.shifts ? FactorText(run.shifts->worst_factor) : "",
                    run.shifts ? FactorText(run.shifts->least_possible) : "",
                    run.shifts && !run.shifts->lost.empty() ? OrderRanges(run.shifts->lost) : ""});
  return TextTable({{"run"},
                    {"readings", true},
                    {"minutes", true},
                    {"dof left", true},
                    {"mean variance factor", true},
                    {"worst", true},
                    {"lower bound", true},
                    {"not separable harmonics"}},
                   rows, kPlanWidth);
}

bool IsPhase(const std::string& result) {
  return result.find("phase") != std::string::npos || result.find("azimuth") != std::string::npos;
}

/// Two digits; nothing of a phase, whose u follows from the amplitude that the run finds.
std::string UText(const std::string& result, double u) {
  return std::isfinite(u) && !IsPhase(result) ? fmt::format("{:.2g}", u) : "-";
}

constexpr const char* kOfPhases = "-: u of a phase follows from the amplitude that the run finds\n";

/// Of a result when the programme has been made after the first run.
double UncertaintyAfter(const PlannedProgramme& programme, const Certainty& result) {
  const auto gain = std::ranges::find(programme.gains, result.name, &plan::Gain::name);
  return gain == programme.gains.end() ? result.rms_u : gain->ratio * result.rms_u;
}

/// A row a result, a column a run; beside the first its mean and what the programme makes of it.
std::string CertaintyTable(const std::vector<PlannedRun>& runs, const std::vector<PlannedProgramme>& programme) {
  const PlannedRun& own = runs.front();
  std::vector<TextColumn> columns = {{"standard uncertainty (rms)"}};
  for (std::size_t i = 0; i < runs.size(); ++i) columns.push_back({fmt::format("run {}", i + 1), true});
  if (own.mean_of > 1) columns.push_back({fmt::format("run 1, mean of {}", own.mean_of), true});
  if (!programme.empty()) columns.push_back({"run 1 + programme", true});
  std::vector<std::vector<std::string>> rows;
  bool has_phases = false;
  for (const Certainty& result : own.outlook.results) {
    std::vector<std::string> row = {WithWords(result.name)};
    for (const PlannedRun& run : runs) row.push_back(UText(result.name, UncertaintyOf(run.outlook, result.name)));
    if (own.mean_of > 1) row.push_back(UText(result.name, UncertaintyOf(own.mean, result.name)));
    if (!programme.empty()) row.push_back(UText(result.name, UncertaintyAfter(programme.front(), result)));
    has_phases = has_phases || IsPhase(result.name);
    rows.push_back(std::move(row));
  }
  const std::string mean = "mean: over runs with other seeds; where an evaluation finds the noise in its readings, one run's u scatters about it\n";
  return TextTable(columns, rows, kPlanWidth) + (own.mean_of > 1 ? mean : "") + (has_phases ? kOfPhases : "");
}

constexpr std::array kOrdersTold = {1, 2, 3, 4, 6, 9, 12, 18};

std::string UncertaintyAt(const HarmonicCertainty& curve, int order) {
  const auto at = std::ranges::find(curve.orders, order);
  if (at == curve.orders.end()) return "";
  const double u = curve.u[static_cast<std::size_t>(at - curve.orders.begin())];
  return std::isfinite(u) ? fmt::format("{:.2g}", u) : "-";
}

/// "0.21 (17)": the largest, and its order.
std::string WorstOrder(const HarmonicCertainty& curve) {
  std::size_t worst = 0;
  for (std::size_t k = 1; k < curve.u.size(); ++k) {
    if (!(curve.u[k] <= curve.u[worst])) worst = k;
  }
  if (curve.u.empty() || !std::isfinite(curve.u[worst])) return "-";
  return fmt::format("{:.2g} ({})", curve.u[worst], curve.orders[worst]);
}

/// A row a curve: standard uncertainties of some orders and of the worst.
std::string HarmonicsOfRun(const Outlook& outlook) {
  std::vector<TextColumn> columns = {{"standard uncertainty at order"}};
  for (const int order : kOrdersTold) columns.push_back({fmt::format("{}", order), true});
  columns.push_back({"worst (order)", true});
  std::vector<std::vector<std::string>> rows;
  for (const HarmonicCertainty& curve : outlook.harmonics) {
    std::vector<std::string> row = {curve.name};
    for (const int order : kOrdersTold) row.push_back(UncertaintyAt(curve, order));
    row.push_back(WorstOrder(curve));
    rows.push_back(std::move(row));
  }
  const std::string table = TextTable(columns, rows, kPlanWidth);
  return table.empty() ? "" : table + "\n";
}

Json HarmonicsJson(const Outlook& outlook) {
  Json list = Json::array();
  for (const HarmonicCertainty& curve : outlook.harmonics) {
    Json u = Json::array();
    for (const double one : curve.u) u.push_back(std::isfinite(one) ? Json(one) : Json());
    list.push_back({{"name", curve.name}, {"order", curve.orders}, {"u", u}});
  }
  return list;
}

}  // namespace

std::string ShiftList(const std::vector<int>& shifts) {
  return fmt::format("{}", fmt::join(shifts, ", "));
}

std::string PlanText(const std::vector<PlannedRun>& runs, const PlannedEffects& effects, const std::vector<PlannedProgramme>& programme) {
  std::string text = RunsTable(runs);
  const bool shifted = std::ranges::any_of(runs, [](const PlannedRun& run) { return run.shifts.has_value(); });
  if (shifted)
    text += "variance: of one table's harmonic over that of the mean of all mountings\n";
  text += "\n" + CertaintyTable(runs, programme) + "\n" + HarmonicsOfRun(runs.front().outlook);
  return text + NotSeparableText(runs.front().outlook.not_separable, kPlanWidth) + "\n" + PlannedEffectsText(effects);
}

std::string OutlookText(const Outlook& outlook) {
  std::vector<std::vector<std::string>> rows;
  for (const Certainty& result : outlook.results)
    rows.push_back({WithWords(result.name), fmt::format("{}", result.values), UText(result.name, result.rms_u), UText(result.name, 2.0 * result.rms_u)});
  const std::string table = TextTable({{"result"}, {"values", true}, {"expected u (rms)", true}, {"U = 2 u", true}}, rows, kPlanWidth);
  const bool has_phases = std::ranges::any_of(outlook.results, IsPhase, &Certainty::name);
  return table + (has_phases ? kOfPhases : "") + NotSeparableText(outlook.not_separable, kPlanWidth);
}

Json OutlookJson(const PlannedRun& run) {
  Json results = Json::array();
  for (const Certainty& result : run.outlook.results)
    results.push_back(
        {{"name", result.name}, {"values", result.values}, {"rms_u", result.rms_u}, {"worst_u", result.worst_u}});
  for (std::size_t k = 0; k < results.size() && run.mean_of > 1; ++k) results[k]["mean_rms_u"] = run.mean.results[k].rms_u;
  Json json = {{"run", run.words},
               {"readings", run.outlook.readings},
               {"minutes", run.outlook.minutes},
               {"dof", std::isfinite(run.outlook.dof) ? Json(run.outlook.dof) : Json()},
               {"results", results},
               {"mean_of", run.mean_of},
               {"harmonics", HarmonicsJson(run.outlook)},
               {"not_separable", run.outlook.not_separable}};
  if (!run.shifts) return json;
  const auto number = [](double x) { return std::isfinite(x) ? Json(x) : Json(); };
  json["shifts"] = {{"shifts", run.shifts->shifts},
                    {"mean_variance_factor", number(run.shifts->mean_factor)},
                    {"least_possible_mean_factor", run.shifts->least_possible},
                    {"worst_variance_factor", number(run.shifts->worst_factor)},
                    {"lost_harmonics", run.shifts->lost},
                    {"every_set_looked_at", run.shifts->exhaustive}};
  return json;
}

Json PlanJson(const std::vector<PlannedRun>& runs, const PlannedEffects& effects) {
  Json json = PlannedEffectsJson(effects);
  json["runs"] = Json::array();
  for (const PlannedRun& run : runs) json["runs"].push_back(OutlookJson(run));
  return json;
}

}  // namespace twinbench::report
