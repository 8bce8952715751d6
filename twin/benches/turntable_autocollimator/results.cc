#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "twin/benches/turntable_autocollimator/bench.h"
#include "twin/benches/turntable_autocollimator/estimators/turntable_bench.h"
#include "twin/benches/turntable_autocollimator/parts_of_results.h"
#include "twin/benches/turntable_autocollimator/series_json.h"
#include "twin/benches/turntable_autocollimator/settings.h"
#include "twin/core/errors.h"
#include "twin/core/written_number.h"
#include "twin/report/curve_score.h"
#include "twin/report/json_units.h"
#include "twin/report/sound.h"
#include "twin/report/uncertainty_parts.h"

namespace twinbench::benches::turntable {
namespace {

using separate::turntable::AnalyseTurntable;
using separate::turntable::AngleSeries;
using separate::turntable::ErrorSize;
using separate::turntable::HarmonicModel;
using separate::turntable::IndexingSeparation;
using separate::turntable::IndexingStatus;
using separate::turntable::ModelCheck;
using separate::turntable::PointStatus;
using separate::turntable::PointwiseError;
using separate::turntable::Roll;
using separate::turntable::RollStatus;
using separate::turntable::SourceVariances;
using separate::turntable::TurntableAnalysis;
// Besides those below.
using turntable::CurveOf;
using turntable::ToJson;

/// The scatter of the readings is noise as far as the autocollimator is stated to have it; the rest, seating and
/// what else changes from pass to pass, is repeatability.
double NoiseShare(const IndexingSeparation& s, double stated_noise_rad) {
  return std::min(1.0, std::pow(stated_noise_rad / (s.scale * s.noise.u_x_rad), 2));
}

/// Behind the noise that the uncertainties are made of; where the residuals scale it, they are.
double DofOf(const IndexingSeparation& s) {
  if (s.scale > 1.0) return s.dof;
  return s.noise.dof > 0 ? s.noise.dof : std::numeric_limits<double>::infinity();
}

/// Says it of all that stands in `json`.
void SayDof(const IndexingSeparation& s, nlohmann::json& json) {
  if (std::isfinite(DofOf(s))) json["dof"] = DofOf(s);
}

/// Of what the scatter of the readings alone makes uncertain.
nlohmann::json PartsOfScatter(double of_noise) {
  return report::PartsJson({{"noise", of_noise}, {"repeatability", 1.0 - of_noise}});
}

nlohmann::json PartsOf(const AngleSeries& series, const IndexingSeparation& s, double stated_noise_rad) {
  const double of_noise = NoiseShare(s, stated_noise_rad);
  const auto list = [](const Eigen::VectorXd& variance) {
    return std::vector<double>(variance.begin(), variance.end());
  };
  const Eigen::VectorXd all = series.cov_rad2.diagonal(), of_roll = series.sources->of_roll_rad.cwiseAbs2();
  const auto& teeth = series.sources->of_teeth_rad2;
  const Eigen::VectorXd of_teeth = teeth ? teeth->diagonal() : Eigen::VectorXd::Zero(all.size());
  const Eigen::VectorXd of_readings = (all - of_roll - of_teeth).cwiseMax(0.0);
  return report::PartsJson(list(all), {{"noise", list(of_noise * of_readings)},
                                       {"repeatability", list((1.0 - of_noise) * of_readings)},
                                       {"roll", list(of_roll)},
                                       {"standard", list(of_teeth)}});
}

nlohmann::json PartsOf(const SourceVariances& v, double of_noise) {
  const double all = v.readings + v.roll + v.teeth;
  return report::PartsJson({{"noise", of_noise * v.readings / all},
                            {"repeatability", (1.0 - of_noise) * v.readings / all},
                            {"roll", v.roll / all},
                            {"standard", v.teeth / all}});
}

/// Of its terms. A series of unknown uncertainty has that of its scatter about the model.
nlohmann::json ModelJson(const HarmonicModel& model, double of_noise) {
  nlohmann::json json = ToJson(model);
  if (model.of_amplitudes_rad2.empty()) json["u_parts"] = PartsOfScatter(of_noise);
  for (std::size_t k = 0; k < model.of_amplitudes_rad2.size(); ++k)
    json["terms"][k]["u_parts"] = {{"amplitude_arcsec", PartsOf(model.of_amplitudes_rad2[k], of_noise)},
                                   {"phase_deg", PartsOf(model.of_phases_rad2[k], of_noise)}};
  return json;
}

nlohmann::json ToJson(const Roll& roll) {
  static const std::map<RollStatus, const char*> kNames = {{RollStatus::kOk, "ok"},
                                                           {RollStatus::kGiven, "given"},
                                                           {RollStatus::kTiltsAlike, "tilts_alike"},
                                                           {RollStatus::kTiltsHidden, "tilts_hidden"},
                                                           {RollStatus::kNoiseNotKnown, "noise_not_known"}};
  return {{"status", kNames.at(roll.status)},
          {"gamma_mrad", report::In(units::mrad, roll.gamma_rad)},
          {"u_gamma_mrad", report::In(units::mrad, roll.u_gamma_rad)}};
}

nlohmann::json ToJson(const ErrorSize& size) {
  return {{"count", size.count},
          {"peak_to_valley_arcsec", report::Arcsec(size.peak_to_valley_rad)},
          {"rms_arcsec", report::Arcsec(size.rms_rad)},
          {"largest_arcsec", report::Arcsec(size.largest_rad)},
          {"largest_from_start_arcsec", report::Arcsec(size.largest_from_start_rad)}};
}

nlohmann::json ToJson(const ModelCheck& check) {
  nlohmann::json json = {{"before", ToJson(check.before)},
                         {"after", ToJson(check.after)},
                         {"expected_rms_arcsec", report::Arcsec(check.expected_rms_rad)}};
  for (std::size_t k = 0; k < check.position_rad.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    json["position_deg"].push_back(WrittenNumber(check.position_rad[k], units::deg));
    json["error_arcsec"].push_back(report::Arcsec(check.error_rad[i]));
    json["rest_arcsec"].push_back(report::Arcsec(check.rest_rad[i]));
  }
  return json;
}

nlohmann::json ToJson(const std::vector<PointwiseError>& pointwise) {
  nlohmann::json json = nlohmann::json::object();
  for (const PointwiseError& point : pointwise) {
    json["position_deg"].push_back(WrittenNumber(point.turntable_rad, units::deg));
    json["ez_arcsec"].push_back(report::Arcsec(point.value_rad));
    json["u_ez_arcsec"].push_back(report::Arcsec(point.u_rad));
    json["status"].push_back(point.status == PointStatus::kOk         ? "ok"
                             : point.status == PointStatus::kNearPole ? "near_pole"
                                                                      : "missing");
  }
  return json;
}

uncertainty::Joint JointOf(const std::string& name, const AngleSeries& series) {
  uncertainty::Joint joint{name, {}, series.cov_rad2.ToDense() / (units::arcsec * units::arcsec)};
  for (std::size_t i = 0; i < series.position_rad.size(); ++i)
    joint.names.push_back(fmt::format("{}.ez_arcsec[{}]", name, i));
  return joint;
}

std::vector<uncertainty::Joint> JointsOf(const IndexingSeparation& s) {
  std::vector<uncertainty::Joint> joints = {JointOf("separation.turntable", s.turntable)};
  if (!s.multitooth.position_rad.empty()) joints.push_back(JointOf("separation.multitooth", s.multitooth));
  return joints;
}

nlohmann::json NotSeparable(const IndexingSeparation& s) {
  nlohmann::json lost = nlohmann::json::array();
  if (s.status == IndexingStatus::kSumOnly) {
    lost.push_back({{"what", "turntable and multi-tooth table"},
                    {"why", "one shift shows only the sum of both; it is counted as the turntable's"}});
    return lost;
  }
  for (const int order : s.lost_harmonics) {
    lost.push_back({{"what", fmt::format("order {}", order)},
                    {"why", "the shifts show only the sum of both tables; it is counted as the turntable's"}});
  }
  return lost;
}

nlohmann::json SeparationJson(const IndexingSeparation& s, const Scenario& scenario) {
  const double stated_noise_rad = TurntableOf(scenario).ReadingNoise_rad();
  nlohmann::json json = {{"turntable", ToJson(s.turntable)},
                         {"not_separable", NotSeparable(s)},
                         {"residual_rms", {{"x_arcsec", report::Arcsec(s.residual_rms_rad)}}},
                         {"dof", report::In(1.0, s.dof)},
                         {"roll", ToJson(s.roll)}};
  json["turntable"]["u_parts"] = PartsOf(s.turntable, s, stated_noise_rad);
  SayDof(s, json["turntable"]);
  if (std::isfinite(s.roll.u_gamma_rad)) json["roll"]["u_parts"] = PartsOfScatter(NoiseShare(s, stated_noise_rad));
  if (s.multitooth.position_rad.empty()) return json;
  json["multitooth"] = ToJson(s.multitooth);
  json["multitooth"]["u_parts"] = PartsOf(s.multitooth, s, stated_noise_rad);
  SayDof(s, json["multitooth"]);
  return json;
}

nlohmann::json ResultsOf(const TurntableAnalysis& a, const Scenario& scenario) {
  nlohmann::json json = {{"estimator", EstimatorName(a.estimator)}, {"readings", a.used}, {"left_out", a.left_out}};
  if (a.separation) {
    json["separation"] = SeparationJson(*a.separation, scenario);
    json["noise"] = {{"u_x_arcsec", report::Arcsec(a.separation->noise.u_x_rad)},
                     {"u_y_arcsec", report::Arcsec(a.separation->noise.u_y_rad)},
                     {"dof", a.separation->noise.dof}};
    json["notes"] = a.separation->notes;
    json["before"] = ToJson(a.before);
  }
  if (!a.pointwise.empty()) json["equation_5"] = ToJson(a.pointwise);
  const double of_noise = a.separation ? NoiseShare(*a.separation, TurntableOf(scenario).ReadingNoise_rad()) : 0.0;
  if (!a.pointwise.empty() && a.separation) json["equation_5"]["u_parts"] = PartsOfScatter(of_noise);
  if (!a.pointwise.empty() && a.separation) SayDof(*a.separation, json["equation_5"]);
  if (a.model) json["model"] = ModelJson(*a.model, of_noise);
  if (a.model && !a.model->of_amplitudes_rad2.empty()) SayDof(*a.separation, json["model"]);
  if (a.check) json["verification"] = ToJson(*a.check);
  if (!a.not_separated.empty()) json["not_separated"] = a.not_separated;
  return json;
}

void DropUncertainties(nlohmann::json& node) {
  for (auto item = node.begin(); node.is_object() && item != node.end();)
    item = item.key().starts_with("u_") ? node.erase(item) : std::next(item);
  for (nlohmann::json& inner : node)
    if (inner.is_structured()) DropUncertainties(inner);
}

/// Of readings at one pass and mounting nothing is left over: they are the errors, and nobody knows how well.
void SayNoUncertainty(report::Evaluation& evaluation) {
  constexpr const char* kReadOnce = "no position was read twice: the errors are the readings, without an uncertainty";
  for (nlohmann::json* json : {&evaluation.results, &evaluation.separation}) DropUncertainties(*json);
  evaluation.results["notes"].push_back(kReadOnce);
  evaluation.summary += fmt::format("note: {}\n", kReadOnce);
}

bool IsWithoutUncertainty(const IndexingSeparation& s) {
  return !(s.noise.u_x_rad > 0.0) && s.turntable.value_rad.size() > 0 && s.turntable.value_rad.allFinite();
}

std::string RollText(const Roll& roll) {
  static const std::map<RollStatus, const char*> kWhyNot = {
      {RollStatus::kTiltsAlike, "the mountings differ in tilt by no more than noise"},
      {RollStatus::kTiltsHidden, "it takes two mountings of equal shift, or three of different ones, that differ in tilt"},
      {RollStatus::kNoiseNotKnown, "a single reading is left over, which does not tell it from noise"}};
  if (const auto why = kWhyNot.find(roll.status); why != kWhyNot.end())
    return fmt::format("roll of the crosshair: not seen, {}\n", why->second);
  return fmt::format("roll of the crosshair   {:.3f} ± {:.3f} mrad\n", roll.gamma_rad / units::mrad,
                     roll.u_gamma_rad / units::mrad);
}

std::string SizeText(const char* name, const ErrorSize& size) {
  return fmt::format("{:22}  largest {:.2f} arcsec, peak to valley {:.2f}, rms {:.2f} ({} positions)\n", name,
                     size.largest_rad / units::arcsec, size.peak_to_valley_rad / units::arcsec,
                     size.rms_rad / units::arcsec, size.count);
}

std::string ModelText(const HarmonicModel& model) {
  const std::string orders = model.highest_order == 0   ? "no order: none stands out of what single positions have"
                             : model.highest_order == 1 ? "order 1"
                                                        : fmt::format("orders 1 to {}", model.highest_order);
  return fmt::format("harmonic model          {}\n", orders);
}

std::string SummaryOf(const TurntableAnalysis& a) {
  std::string text = fmt::format("{} readings of the full circle", a.used);
  text += a.left_out > 0 ? fmt::format(", {} without numbers left out\n", a.left_out) : "\n";
  if (!a.separation) return text + fmt::format("no separation: {}\n", a.not_separated);
  text += RollText(a.separation->roll) + SizeText("turntable", a.before);
  if (!a.separation->multitooth.position_rad.empty()) {
    text += SizeText("multi-tooth table", separate::turntable::DescribeErrors(a.separation->multitooth.value_rad));
  }
  if (a.model) text += ModelText(*a.model);
  if (a.check) {
    text += SizeText("check, as read", a.check->before) + SizeText("check, less the model", a.check->after);
  }
  for (const std::string& note : a.separation->notes) text += fmt::format("note: {}\n", note);
  if (!a.not_separated.empty()) text += fmt::format("no model: {}\n", a.not_separated);
  return text;
}

void AddTilt(const TurntableAnalysis& a, const Scenario& scenario, report::Evaluation& evaluation) {
  const TurntableSettings& bench = TurntableOf(scenario);
  const report::ErrorMotionTexts tilt =
      EvaluateTilt(a.stops, bench.turntable_procedure.positions, *a.separation, bench.ReadingNoise_rad());
  if (!tilt.json.empty()) evaluation.results["iso230_7"] = tilt.json;
  evaluation.summary += tilt.text;
}

// --- against the truth ---

report::CurveScore WithDof(report::CurveScore curve, double dof) {
  curve.dof = dof;
  return curve;
}

/// Equation 5 counts from its first position, and so does the truth here. Where it is invalid it is not compared.
report::CurveScore CurveOf(const std::vector<PointwiseError>& pointwise, double dof, const nlohmann::json& table) {
  report::CurveScore curve{
      .name = "equation 5", .value = "ez_arcsec", .position = {}, .estimate = {}, .u = {}, .truth = {}};
  std::vector<double> position_rad, truth;
  for (const PointwiseError& point : pointwise) position_rad.push_back(point.turntable_rad);
  truth = TruthAt(table, position_rad);
  const auto start = std::ranges::find(pointwise, 0.0, &PointwiseError::u_rad);
  for (std::size_t k = 0; k < pointwise.size(); ++k) {
    const PointwiseError& point = pointwise[k];
    if (!(point.u_rad > 0.0) || start == pointwise.end()) continue;
    curve.position.push_back(WrittenNumber(point.turntable_rad, units::deg));
    curve.estimate.push_back(point.value_rad / units::arcsec);
    curve.u.push_back(point.u_rad / units::arcsec);
    curve.truth.push_back(truth[k] - truth[static_cast<std::size_t>(start - pointwise.begin())]);
  }
  curve.dof = dof;
  return curve;
}

report::CurveScore CurveOf(const HarmonicModel& model, const ModelCheck& check, const nlohmann::json& table) {
  report::CurveScore curve{
      .name = "model at checks", .value = "ez_arcsec", .position = {}, .estimate = {}, .u = {}, .truth = {}};
  double mean = 0.0;
  for (const double angle_rad : check.position_rad) {
    const auto point = model.At(angle_rad);
    curve.position.push_back(angle_rad / units::deg);
    curve.estimate.push_back(point.value_rad / units::arcsec);
    curve.u.push_back(point.u_rad / units::arcsec);
    mean += curve.estimate.back() / static_cast<double>(check.position_rad.size());
  }
  for (double& value : curve.estimate) value -= mean;
  curve.truth = TruthAt(table, check.position_rad);
  return curve;
}

}  // namespace

report::Evaluation Evaluate(const Scenario& scenario, const std::vector<Reading>& readings, Estimator estimator) {
  if (TurntableOf(scenario).HasPolygon()) return EvaluatePolygon(scenario, readings, estimator);
  const TurntableAnalysis analysis = AnalyseTurntable(readings, scenario, estimator);
  const nlohmann::json separation =
      analysis.separation ? SeparationJson(*analysis.separation, scenario) : nlohmann::json();
  report::Evaluation evaluation{ResultsOf(analysis, scenario), separation, analysis.not_separated,
                                SummaryOf(analysis)};
  if (analysis.stops.empty() && separate::turntable::AnalyseSweep(readings)) evaluation.summary.clear();  // nothing was asked of a table
  if (const auto sweep = separate::turntable::AnalyseSweep(WithoutFarOfSweep(readings, evaluation))) AddSweep(*sweep, evaluation);
  if (analysis.separation) AddTilt(analysis, scenario, evaluation);
  if (analysis.separation) evaluation.misfits = {report::WidenedMisfit("the separation of both tables", analysis.separation->scale)};
  if (analysis.separation && IsWithoutUncertainty(*analysis.separation))
    SayNoUncertainty(evaluation);
  else if (analysis.separation) evaluation.joints = [separation = *analysis.separation] { return JointsOf(separation); };
  return evaluation;
}

report::ScoredRun ScoreRun(const Scenario& scenario, const std::vector<Reading>& readings,
                           const nlohmann::json& truth, Estimator estimator) {
  if (TurntableOf(scenario).HasPolygon()) return ScorePolygon(scenario, readings, truth, estimator);
  const TurntableAnalysis analysis = AnalyseTurntable(readings, scenario, estimator);
  if (!analysis.separation) throw InputError("the run", analysis.not_separated, "a run with a full circle");
  const nlohmann::json& turntable = truth.at("turntable");
  const double dof = DofOf(*analysis.separation);
  std::vector<report::CurveScore> curves = {
      WithDof(CurveOf("turntable", analysis.separation->turntable, turntable), dof)};
  const AngleSeries& multitooth = analysis.separation->multitooth;
  if (!multitooth.position_rad.empty()) {
    curves.push_back(WithDof(CurveOf("multitooth", multitooth, truth.at("multitooth")), dof));
    TakeOutLost(analysis.separation->lost_harmonics, TurntableOf(scenario).turntable_procedure.positions, curves.back());
  }
  if (!analysis.pointwise.empty()) curves.push_back(CurveOf(analysis.pointwise, dof, turntable));
  if (analysis.model && analysis.check) curves.push_back(CurveOf(*analysis.model, *analysis.check, turntable));
  return {ToJson(curves), "against the truth; means are taken out of both\n" + report::ScoreTable(curves),
          report::PositionTable(curves), report::ValuesOf(curves)};
}

}  // namespace twinbench::benches::turntable
