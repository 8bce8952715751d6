#include "twin/benches/turntable_autocollimator/polygon_results.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "twin/benches/turntable_autocollimator/estimators/polygon_analysis.h"
#include "twin/benches/turntable_autocollimator/series_json.h"
#include "twin/core/errors.h"
#include "twin/core/units.h"
#include "twin/report/curve_score.h"
#include "twin/report/json_units.h"

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

nlohmann::json ClosureJson(const PolygonClosure& c) {
  nlohmann::json polygon = ToJson(c.polygon);
  polygon["face"] = c.face;
  return {{"turntable", ToJson(c.turntable)},
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
  json["separation"] = ClosureJson(*a.closure);
  json["model"] = ToJson(a.closure->encoder);
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

}  // namespace

report::Evaluation EvaluatePolygon(const Scenario& scenario, const std::vector<Reading>& readings,
                                   Estimator estimator) {
  const PolygonAnalysis a = separate::turntable::AnalysePolygon(readings, scenario, estimator);
  const nlohmann::json separation = a.closure ? ClosureJson(*a.closure) : nlohmann::json();
  return {PolygonJson(a), separation, a.not_separated, PolygonSummary(a)};
}

report::ScoredRun ScorePolygon(const Scenario& scenario, const std::vector<Reading>& readings,
                               const nlohmann::json& truth, Estimator estimator) {
  const PolygonAnalysis a = separate::turntable::AnalysePolygon(readings, scenario, estimator);
  if (!a.closure)
    throw InputError("the run", a.not_separated, "a run in which encoder and polygon can be told apart");
  const std::vector<report::CurveScore> curves = {CurveOf("turntable", a.closure->turntable, truth.at("turntable")),
                                                  CurveOf("polygon", a.closure->polygon, truth.at("polygon"))};
  return {report::ToJson(curves), "against the truth; means are taken out of both\n" + report::ScoreTable(curves),
          report::PositionTable(curves), report::ValuesOf(curves)};
}

}  // namespace twinbench::benches::turntable
