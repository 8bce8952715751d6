#include "twin/benches/turntable_autocollimator/parts_of_results.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "twin/benches/turntable_autocollimator/estimators/polygon_analysis.h"
#include "twin/benches/turntable_autocollimator/series_json.h"
#include "twin/benches/turntable_autocollimator/settings.h"
#include "twin/core/errors.h"
#include "twin/core/units.h"
#include "twin/report/curve_orders.h"
#include "twin/report/curve_score.h"
#include "twin/report/json_units.h"
#include "twin/report/sound.h"
#include "twin/report/uncertainty_parts.h"

namespace twinbench::benches::turntable {
namespace {

using separate::turntable::AngleSeries;
using separate::turntable::HiddenOrder;
using separate::turntable::OrderHidden;
using separate::turntable::PolygonAnalysis;
using separate::turntable::PolygonClosure;

const char* WhyHidden(OrderHidden by) {
  switch (by) {
    case OrderHidden::kByConstants:
      return "it is the same at all faces of a clamping, and counted as the clamping's constant";
    case OrderHidden::kByPolygon:
      return "it is the same in all clampings, and counted as the polygon's";
    case OrderHidden::kByLowerOrders:
      return "it looks like lower orders at the angles that were read, and is counted as theirs";
  }
  return "";
}

nlohmann::json HiddenJson(const std::vector<HiddenOrder>& hidden) {
  nlohmann::json json = nlohmann::json::array();
  for (const HiddenOrder& h : hidden)
    json.push_back({{"what", fmt::format("turntable order {}", h.order)}, {"why", WhyHidden(h.by)}});
  return json;
}

/// Shares that sources have of the scatter of a reading. What none is stated for is repeatability.
std::vector<std::pair<std::string, double>> SharesOfReading(const PolygonAnalysis& a) {
  const double seen_rad2 = std::pow(a.closure->noise.scale * a.closure->noise.u_rad, 2);
  const double all_rad2 = std::max(seen_rad2, std::pow(a.Stated_rad(), 2));
  std::vector<std::pair<std::string, double>> shares = {
      {"noise", 0.0}, {"quantisation", 0.0}, {"repeatability", 0.0}};
  double left = 1.0;
  for (const auto& s : a.stated) {
    const double share = all_rad2 > 0.0 ? s.u_rad * s.u_rad / all_rad2 : 0.0;
    std::ranges::find(shares, s.part, &std::pair<std::string, double>::first)->second += share;
    left -= share;
  }
  shares.back().second += std::max(0.0, left);
  return shares;
}

/// @param scatter_rad2  What the readings' scatter makes of the variances; the rest is the published closure's own.
nlohmann::json PartsOf(const Eigen::VectorXd& variance_rad2, const Eigen::VectorXd& scatter_rad2,
                       const PolygonAnalysis& a) {
  const auto list = [](const Eigen::VectorXd& values) { return std::vector<double>(values.begin(), values.end()); };
  std::vector<report::VariancePart> parts = {{"model", list(variance_rad2 - scatter_rad2)}};
  for (const auto& [part, share] : SharesOfReading(a)) parts.push_back({part, list(share * scatter_rad2)});
  return report::PartsJson(list(variance_rad2), parts);
}

/// The error's orders: both coefficients of each together.
nlohmann::json ModelJson(const PolygonAnalysis& a) {
  nlohmann::json json = ToJson(a.closure->encoder);
  const auto of_reading = SharesOfReading(a);
  for (std::size_t k = 0; k < json["terms"].size(); ++k) {
    const Eigen::Index at = 2 * a.closure->encoder.terms[k].order - 1;
    const double variance = a.closure->encoder.cov_rad2.diagonal().segment<2>(at).sum();
    const double scatter = variance > 0.0 ? a.coefficients_rad2.segment<2>(at).sum() / variance : 1.0;
    std::vector<std::pair<std::string, double>> shares = {{"model", 1.0 - scatter}};
    for (const auto& [part, share] : of_reading) shares.emplace_back(part, share * scatter);
    json["terms"][k]["u_parts"] = report::PartsJson(shares);
  }
  return json;
}

nlohmann::json ClosureJson(const PolygonAnalysis& a) {
  const PolygonClosure& c = *a.closure;
  nlohmann::json turntable = ToJson(c.turntable);
  turntable["u_parts"] = PartsOf(c.turntable.cov_rad2.diagonal(), a.turntable_rad2, a);
  nlohmann::json polygon = ToJson(c.polygon);
  polygon["face"] = c.face;
  polygon["u_parts"] = PartsOf(c.polygon.cov_rad2.diagonal(), a.polygon_rad2, a);
  return {{"turntable", turntable},
          {"polygon", polygon},
          {"not_separable", HiddenJson(c.hidden)},
          {"residual_rms", {{"x_arcsec", report::Arcsec(c.residual_rms_rad)}}},
          {"dof", report::In(1.0, c.noise.dof)}};
}

/// What scatters a reading, as the scenario states it and as the readings show it.
nlohmann::json ReadingJson(const PolygonAnalysis& a) {
  nlohmann::json stated = nlohmann::json::array();
  for (const auto& s : a.stated) stated.push_back({{"source", s.source}, {"u_arcsec", report::Arcsec(s.u_rad)}});
  const auto& noise = a.closure->noise;
  return {{"stated", stated},
          {"stated_together_arcsec", report::Arcsec(a.Stated_rad())},
          {"seen_arcsec", report::Arcsec(noise.u_rad)},
          {"seen_in", noise.is_of_repeats ? "repeats" : "residuals"},
          {"scale", noise.scale}};
}

double RootMeanSquareU_rad(const AngleSeries& series) {
  return std::sqrt(series.cov_rad2.diagonal().mean());
}

nlohmann::json PolygonJson(const PolygonAnalysis& a) {
  nlohmann::json json = {{"estimator", EstimatorName(a.estimator)},
                         {"readings", a.used},
                         {"left_out", a.left_out},
                         {"clampings", a.clampings}};
  if (!a.not_separated.empty()) json["not_separated"] = a.not_separated;
  if (!a.closure) return json;
  json["separation"] = ClosureJson(a);
  json["model"] = ModelJson(a);
  json["reading"] = ReadingJson(a);
  json["expanded_k2"] = {{"turntable_arcsec", report::Arcsec(2.0 * RootMeanSquareU_rad(a.closure->turntable))},
                         {"polygon_arcsec", report::Arcsec(2.0 * RootMeanSquareU_rad(a.closure->polygon))}};
  if (a.estimator == Estimator::kPublished) json["method_bias_arcsec"] = report::Arcsec(a.method_bias_rad);
  json["notes"] = a.closure->notes;
  return json;
}

std::string RangeText(const char* name, const AngleSeries& series) {
  const double range_rad = series.value_rad.maxCoeff() - series.value_rad.minCoeff();
  return fmt::format("{:22}  peak to valley {:.3f} arcsec, U (k = 2) {:.4f} arcsec at {} angles\n", name,
                     range_rad / units::arcsec, 2.0 * RootMeanSquareU_rad(series) / units::arcsec,
                     series.position_rad.size());
}

std::string ReadingText(const PolygonAnalysis& a) {
  const auto& noise = a.closure->noise;
  std::string text = fmt::format("one reading             {:.4f} arcsec in the {}", noise.u_rad / units::arcsec,
                                 noise.is_of_repeats ? "repeats" : "residuals");
  if (noise.scale > 1.0) text += fmt::format(", times {:.2f}", noise.scale);
  text += fmt::format("; the scenario states {:.4f}:\n", a.Stated_rad() / units::arcsec);
  for (const auto& s : a.stated)
    text += fmt::format("    {:34} {:.4f} arcsec\n", s.source, s.u_rad / units::arcsec);
  return text;
}

std::string TermsText(const PolygonClosure& c) {
  std::string text = "encoder, order          amplitude [arcsec]      u      phase [deg]\n";
  for (const auto& term : c.encoder.terms)
    text += fmt::format("{:14} {:27.4f} {:9.4f} {:12.1f}\n", term.order, term.amplitude_rad / units::arcsec,
                        term.u_amplitude_rad / units::arcsec, term.phase_rad / units::deg);
  return text;
}

std::string PolygonSummary(const PolygonAnalysis& a) {
  std::string text = fmt::format("{} readings of a polygon in {} clampings", a.used, a.clampings);
  text += a.left_out > 0 ? fmt::format(", {} without numbers left out\n", a.left_out) : "\n";
  if (!a.closure) return text + fmt::format("no separation: {}\n", a.not_separated);
  text += RangeText("turntable's encoder", a.closure->turntable) + RangeText("polygon", a.closure->polygon);
  if (a.estimator == Estimator::kPublished)
    text += fmt::format("closure by means        {:.4f} arcsec rms from least squares, in its U\n",
                        a.method_bias_rad / units::arcsec);
  text += TermsText(*a.closure) + ReadingText(a);
  text += "U holds the scatter of the readings; `twinbench uncertainty` adds what is stated by u_ keys\n";
  for (const std::string& note : a.closure->notes) text += fmt::format("note: {}\n", note);
  return text;
}

/// True curves of turntable and polygon without what the clampings' constants have, and with the polygon as it looks:
/// an order of the turntable that is the same in all clampings is in its faces. Multiples of the number of faces are in
/// the constants, however many orders are fitted.
std::pair<nlohmann::json, nlohmann::json> TruthAsSeen(const PolygonClosure& c, const TurntableSettings& own,
                                                      const nlohmann::json& truth) {
  nlohmann::json turntable = truth.at("turntable"), polygon = truth.at("polygon");
  std::vector<int> lost;
  for (const HiddenOrder& h : c.hidden) {
    if (h.by != OrderHidden::kByLowerOrders) lost.push_back(h.order);
    if (h.by != OrderHidden::kByPolygon) continue;
    const std::complex<double> wave = report::OrderOf(turntable, h.order);  // face f stands at offset + f steps, by its own angle at - f
    report::AddOrder(-h.order, wave * std::polar(1.0, h.order * own.FaceAngle_rad(0, 0)), polygon);
  }
  const int first = own.polygon.faces * (c.encoder.highest_order / own.polygon.faces + 1);
  const int most = static_cast<int>(turntable.at("ez_arcsec").size()) / 2;
  for (int order = first; order < most; order += own.polygon.faces) lost.push_back(order);
  report::TakeOutOrders(lost, turntable);
  return {turntable, polygon};
}

}  // namespace

report::Evaluation EvaluatePolygon(const Scenario& scenario, const std::vector<Reading>& readings,
                                   Estimator estimator) {
  const PolygonAnalysis a = separate::turntable::AnalysePolygon(readings, scenario, estimator);
  const nlohmann::json separation = a.closure ? ClosureJson(a) : nlohmann::json();
  report::Evaluation evaluation{PolygonJson(a), separation, a.not_separated, PolygonSummary(a)};
  if (a.closure) evaluation.misfits = {report::WidenedMisfit("the closure of encoder and polygon", a.closure->noise.scale)};
  return evaluation;
}

report::ScoredRun ScorePolygon(const Scenario& scenario, const std::vector<Reading>& readings,
                               const nlohmann::json& truth, Estimator estimator) {
  const PolygonAnalysis a = separate::turntable::AnalysePolygon(readings, scenario, estimator);
  if (!a.closure)
    throw InputError("the run", a.not_separated, "a run in which encoder and polygon are separable");
  const auto [turntable, polygon] = TruthAsSeen(*a.closure, TurntableOf(scenario), truth);
  const std::vector<report::CurveScore> curves = {CurveOf("turntable", a.closure->turntable, turntable),
                                                  CurveOf("polygon", a.closure->polygon, polygon)};
  return {report::ToJson(curves), "against the truth; means are taken out of both\n" + report::ScoreTable(curves),
          report::PositionTable(curves), report::ValuesOf(curves)};
}

}  // namespace twinbench::benches::turntable
