#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>
#include <utility>

#include "twin/benches/encoder_comparison/bench.h"
#include "twin/benches/encoder_comparison/comparison.h"
#include "twin/benches/encoder_comparison/curve_results.h"
#include "twin/benches/encoder_comparison/estimators/coast_passes.h"
#include "twin/benches/encoder_comparison/estimators/device_error.h"
#include "twin/benches/encoder_comparison/estimators/head_readings.h"
#include "twin/benches/encoder_comparison/parts_of_results.h"
#include "twin/benches/encoder_comparison/settings.h"
#include "twin/benches/encoder_comparison/uncertainty_parts.h"
#include "twin/core/errors.h"
#include "twin/core/written_number.h"
#include "twin/report/curve_orders.h"
#include "twin/report/curve_score.h"
#include "twin/report/json_units.h"
#include "twin/report/sound.h"

namespace twinbench::benches::encoder {
namespace {

using separate::encoder::AngleMeans;
using separate::encoder::DeviceError;
using separate::encoder::PassResult;
using separate::harmonics::HarmonicSeries;

constexpr const char* kNoReference =
    "with one mounting of the device the difference of both is known; it is counted as the device's";
constexpr const char* kSeenAlike = "all mountings see only the difference of both; it is counted as the device's";

nlohmann::json CurveOfDevice(const HarmonicSeries& series, const std::string& name, const DeviceError& e,
                             const DeviceSettings& settings) {
  nlohmann::json json = CurveJson(series, name);
  json["u_parts"] = {{name + "_arcsec", CurveParts(series, e, settings, kCurvePoints)}};
  return json;
}

nlohmann::json OrdersOfDevice(const HarmonicSeries& series, const DeviceError& e, const DeviceSettings& settings) {
  nlohmann::json json = HarmonicsJson(series);
  for (nlohmann::json& line : json) line["u_parts"] = OrderParts(line.at("order"), e, settings);
  return json;
}

nlohmann::json HarmonicsOfBoth(const DeviceError& e, const DeviceSettings& settings) {
  nlohmann::json json = {{"form", "sum of amplitude cos(order angle + phase)"},
                         {"highest_order", e.highest_order},
                         {"device", OrdersOfDevice(e.curves.device, e, settings)}};
  if (!e.curves.reference.orders.empty())
    json["reference"] = OrdersOfDevice(e.curves.reference, e, settings);
  return json;
}

nlohmann::json NotSeparable(const DeviceError& e) {
  nlohmann::json lost = nlohmann::json::array();
  if (e.curves.reference.orders.empty()) {
    lost.push_back(
        {{"what", "device and reference"}, {"why", e.mounting_rad.size() > 1 ? kSeenAlike : kNoReference}});
    return lost;
  }
  for (const int order : e.curves.lost)
    lost.push_back({{"what", fmt::format("device and reference, order {}", order)}, {"why", kSeenAlike}});
  return lost;
}

nlohmann::json SeparationJson(const DeviceError& e, const DeviceSettings& settings) {
  nlohmann::json json = {{"device", CurveOfDevice(e.curves.device, "ez", e, settings)},
                         {"harmonics", HarmonicsOfBoth(e, settings)},
                         {"not_separable", NotSeparable(e)},
                         {"residual_rms", {{"x_arcsec", report::Arcsec(e.residual_rms_rad)}}},
                         {"dof", report::In(1.0, e.dof)}};
  if (!e.curves.reference.orders.empty())
    json["reference"] = CurveOfDevice(e.curves.reference, "ez", e, settings);
  return json;
}

/// By the device's angle: the mean, and the curve with it.
nlohmann::json ReversalJson(const DeviceError& e, const DeviceSettings& settings) {
  nlohmann::json json = CurveOfDevice(e.curves.reversal, "reversal", e, settings);
  for (auto& value : json["reversal_arcsec"]) value = value.get<double>() + e.reversal.value_rad / units::arcsec;
  json["mean_arcsec"] = report::Arcsec(e.reversal.value_rad);
  json["u_mean_arcsec"] = report::Arcsec(e.reversal.u_rad);
  if (std::isfinite(e.reversal.u_rad)) json["u_parts"]["mean_arcsec"] = ReversalParts(e, settings);
  return json;
}

/// What was read, by degrees.
nlohmann::json ToJson(const AngleMeans& means, const DeviceError& e, const DeviceSettings& settings) {
  nlohmann::json json = {{"u_parts", MeansParts(means, e, settings)}};
  for (std::size_t i = 0; i < means.count.size(); ++i) {
    json["position_deg"].push_back(WrittenNumber(means.position_rad[i], units::deg));
    json["ez_arcsec"].push_back(report::Arcsec(means.value_rad[i]));
    json["u_ez_arcsec"].push_back(report::Arcsec(means.u_rad[i]));
    json["readings"].push_back(means.count[i]);
  }
  return json;
}

nlohmann::json MeansJson(const DeviceError& e, const DeviceSettings& settings) {
  nlohmann::json json = {{"both", ToJson(e.both, e, settings)}};
  if (!e.forward.count.empty()) json["forward"] = ToJson(e.forward, e, settings);
  if (!e.backward.count.empty()) json["backward"] = ToJson(e.backward, e, settings);
  return json;
}

nlohmann::json ToJson(const PassResult& p) {
  return {{"setup", p.setup},
          {"pass", p.pass},
          {"direction", p.direction},
          {"readings", p.readings},
          {"turns", p.turns},
          {"constant_deg", report::In(units::deg, p.constant_rad)},
          {"slope_arcsec_per_turn", report::Arcsec(p.slope_rad_per_turn)}};
}

void AddDevice(const DeviceError& e, const DeviceSettings& settings, nlohmann::json& json) {
  if (e.highest_order == 0) {
    json["not_separated"] = e.not_separated;
    return;
  }
  json.update(SeparationJson(e, settings));
  if (!e.curves.reversal.orders.empty()) json["reversal"] = ReversalJson(e, settings);
  json["means"] = MeansJson(e, settings);
  for (const PassResult& pass : e.passes) json["passes"].push_back(ToJson(pass));
  for (const double mounting_rad : e.mounting_rad) json["mounting_deg"].push_back(WrittenNumber(mounting_rad, units::deg));
  if (std::isfinite(e.lag_s)) json["lag"] = {{"value_s", e.lag_s}, {"u_s", report::In(1.0, e.u_lag_s)}};
  json["notes"] = e.notes;
}

std::vector<uncertainty::Joint> JointsOf(const separate::encoder::SeparatedCurves& curves) {
  std::vector<uncertainty::Joint> joints = {CurveJoint("device", curves.device, kCurvePoints)};
  if (!curves.reference.orders.empty()) joints.push_back(CurveJoint("reference", curves.reference, kCurvePoints));
  return joints;
}

std::string LostText(const DeviceError& e) {
  if (e.curves.reference.orders.empty())
    return fmt::format("not separable from the reference: {}\n",
                       e.mounting_rad.size() > 1 ? kSeenAlike : kNoReference);
  std::string orders;
  for (const int order : e.curves.lost) orders += fmt::format(" {}", order);
  return orders.empty() ? "" : fmt::format("not separable from the reference, orders{}: {}\n", orders, kSeenAlike);
}

/// Whether any place was read twice: in another pass or mounting, or behind a turn.
bool AreRepeated(const std::vector<Reading>& readings) {
  constexpr double kBeyondATurn = 1.02;
  if (readings.empty()) return false;
  const auto is_of_one_pass = [&first = readings.front()](const Reading& r) { return r.setup == first.setup && r.pass == first.pass; };
  const auto [low, high] = std::ranges::minmax(readings, {}, &Reading::reference_rad);
  return !std::ranges::all_of(readings, is_of_one_pass) || high.reference_rad - low.reference_rad > kBeyondATurn * units::turn;
}

/// @param repeated  Whether any place was read twice: else what is left is of higher orders as well as of noise.
std::string SummaryOf(const DeviceError& e, bool repeated, const AxisUnit& unit) {
  if (e.highest_order == 0) return fmt::format("no curve: {}\n", e.not_separated);
  std::string text = LinesText("device", e.curves.device, unit) + LinesText("reference", e.curves.reference, unit) +
                     LinesText("reversal", e.curves.reversal, unit);
  if (text.empty()) text = "no order stands out of the noise\n";
  if (std::isfinite(e.reversal.value_rad))
    text += fmt::format("forward - backward     {:10.3f} ± {:.3f} {}\n", e.reversal.value_rad / unit.to_SI,
                        e.reversal.u_rad / unit.to_SI, unit.name);
  if (std::abs(e.lag_s) > 3.0 * e.u_lag_s)
    text +=
        fmt::format("device behind by       {:10.4f} ± {:.4f} ms\n", e.lag_s / units::ms, e.u_lag_s / units::ms);
  text += fmt::format("{} {:10.3f} {} (standard deviation){}\n", repeated ? "a reading repeats to  " : "left about the orders ", e.residual_rms_rad / unit.to_SI,
                      unit.name, repeated ? "" : fmt::format(": noise and orders above {}, for no place was read twice", e.highest_order));
  text += UnresolvedText(e.curves.device, unit) + LostText(e);
  for (const std::string& note : e.notes) text += "note: " + note + "\n";
  return text;
}

/// True curves of device and reference; where the mountings see only the difference of both it is the device's.
std::pair<nlohmann::json, nlohmann::json> TruthAsSeen(const DeviceError& e, const nlohmann::json& truth) {
  nlohmann::json device = truth.at("device"), reference = truth.at("reference");
  std::vector<int> lost = e.curves.lost;
  if (e.curves.reference.orders.empty()) {
    lost.resize(static_cast<std::size_t>(e.highest_order));
    std::iota(lost.begin(), lost.end(), 1);
  }
  for (const int order : lost)  // at the device's angle
    report::AddOrder(order, -report::OrderOf(reference, order) * std::polar(1.0, -order * e.mounting_rad.front()), device);
  report::TakeOutOrders(lost, reference);
  return {device, reference};
}

}  // namespace

report::Evaluation Evaluate(const Scenario& scenario, const std::vector<Reading>& readings, Estimator estimator) {
  if (separate::encoder::HaveHeads(readings)) return EvaluateHeads(scenario, readings, estimator);
  if (separate::encoder::HaveStamps(readings)) return EvaluateCoast(scenario, readings, estimator);
  const measure::AngleComparison comparison = measure::CompareAngles(readings);
  const DeviceError device = separate::encoder::SeparateDevice(readings, DeviceOptionsOf(EncoderOf(scenario)));
  const DeviceSettings device_settings = DeviceOfMeans(EncoderOf(scenario));
  report::Evaluation evaluation{
      ToJson(comparison), {}, device.not_separated, Summary(comparison, CoarseUnit(device_settings))};
  evaluation.summary += SummaryOf(device, AreRepeated(readings), FineUnit(device_settings));
  AddDevice(device, device_settings, evaluation.results);
  if (device.highest_order > 0) {
    evaluation.separation = SeparationJson(device, device_settings);
    if (device.curves.dof > 0)
      evaluation.misfits = {report::WidenedMisfit("the separation of device and reference",
                                                  std::sqrt(device.curves.chi2 / device.curves.dof))};
    evaluation.joints = [curves = device.curves] { return JointsOf(curves); };
  }
  if (EncoderOf(scenario).encoder_procedure.kind == "stops") {
    const PositioningResults positioning = EvaluateStops(readings, device_settings, StepsOf(EncoderOf(scenario)));
    evaluation.results["iso230_2"] = positioning.json;
    evaluation.results["vdi3441"] = positioning.vdi;
    evaluation.summary += positioning.text;
  }
  return evaluation;
}

report::ScoredRun ScoreRun(const Scenario& scenario, const std::vector<Reading>& readings,
                           const nlohmann::json& truth, Estimator estimator) {
  if (separate::encoder::HaveHeads(readings)) return ScoreHeads(scenario, readings, truth, estimator);
  if (separate::encoder::HaveStamps(readings)) return ScoreCoast(readings, truth, estimator);
  const DeviceError device = separate::encoder::SeparateDevice(readings, DeviceOptionsOf(EncoderOf(scenario)));
  if (device.highest_order == 0) throw InputError("the run", device.not_separated, "a run with complete turns");
  const auto [of_device, of_reference] = TruthAsSeen(device, truth);
  std::vector<report::CurveScore> curves = {ScoreOf("device", device.curves.device, of_device)};
  if (!device.curves.reference.orders.empty()) curves.push_back(ScoreOf("reference", device.curves.reference, of_reference));
  return {ToJson(curves),
          "against the truth; means are taken out of both\n" + report::ScoreTable(curves) + LostText(device),
          report::PositionTable(curves), report::ValuesOf(curves)};
}

}  // namespace twinbench::benches::encoder
