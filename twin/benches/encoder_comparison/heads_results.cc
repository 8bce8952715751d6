#include "twin/benches/encoder_comparison/parts_of_results.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "twin/benches/encoder_comparison/comparison.h"
#include "twin/benches/encoder_comparison/curve_results.h"
#include "twin/benches/encoder_comparison/estimators/device_error.h"
#include "twin/benches/encoder_comparison/estimators/several_heads.h"
#include "twin/benches/encoder_comparison/uncertainty_parts.h"
#include "twin/core/errors.h"
#include "twin/core/written_number.h"
#include "twin/report/curve_orders.h"
#include "twin/report/json_units.h"
#include "twin/report/uncertainty_parts.h"

namespace twinbench::benches::encoder {
namespace {

using separate::encoder::SeveralHeads;
using separate::harmonics::HarmonicSeries;

constexpr const char* kAllSeeTheSame = "all heads see the same of it; it is in what the reference shows beside them";

/// With the angles that the scenario states, so that how well they are known counts in a budget.
std::vector<Reading> WithStatedHeads(const Scenario& scenario, std::vector<Reading> readings) {
  const std::vector<double>& heads_rad = EncoderOf(scenario).encoder_procedure.heads_rad;
  if (heads_rad.size() < 2) return readings;
  for (Reading& reading : readings)
    reading.head_rad = heads_rad[static_cast<std::size_t>(reading.setup) % heads_rad.size()];
  return readings;
}

SeveralHeads Calibrated(const Scenario& scenario, const std::vector<Reading>& readings, Estimator estimator) {
  const std::vector<Reading> stated = WithStatedHeads(scenario, readings);
  const separate::encoder::HeadOptions options{.steps = StepsOf(EncoderOf(scenario))};
  return estimator == Estimator::kPublished ? separate::encoder::EqualDivision(stated, options)
                                            : separate::encoder::SeparateHeads(stated, options);
}

std::string OrdersText(const std::vector<int>& orders) {
  return fmt::format("{}", fmt::join(orders, ", "));
}

/// Mean over the turn of the curve's variance, and with what the lost orders may be.
struct WholeCurve {
  double u_rad = kNaN, u_whole_rad = kNaN;
};
WholeCurve WholeOf(const SeveralHeads& heads) {
  const Eigen::VectorXd u_rad = separate::encoder::Curve(heads.ring, 360).u_rad;
  const double mean_rad = std::sqrt(u_rad.squaredNorm() / static_cast<double>(u_rad.size()));
  return {mean_rad, std::hypot(mean_rad, heads.lost.assumed_rad)};
}

nlohmann::json NotSeparableOf(const SeveralHeads& heads) {
  nlohmann::json lost = nlohmann::json::array();
  for (const int order : heads.lost.orders)
    lost.push_back({{"what", fmt::format("device, order {}", order)}, {"why", kAllSeeTheSame}});
  return lost;
}

nlohmann::json LostJson(const SeveralHeads& heads) {
  const WholeCurve whole = WholeOf(heads);
  return {{"orders", heads.lost.orders},
          {"assumed_rms_arcsec", report::Arcsec(heads.lost.assumed_rad)},
          {"assumption", "the amplitude of an order falls as 1 / order beside its neighbours"},
          {"curve_rms_u_arcsec", report::Arcsec(whole.u_rad)},
          {"whole_curve_rms_u_arcsec", report::Arcsec(whole.u_whole_rad)}};
}

nlohmann::json RingJson(const SeveralHeads& heads, double of_steps) {
  nlohmann::json json = CurveJson(heads.ring, "ez");
  json["u_parts"] = PublishedCurveParts(heads.ring, heads.ring_by_noise, of_steps, kCurvePoints);
  return json;
}

nlohmann::json OrdersJson(const HarmonicSeries& series, const HarmonicSeries& by_noise, double of_steps) {
  nlohmann::json lines = HarmonicsJson(series);
  AddPublishedOrderParts(series, by_noise, of_steps, lines);
  return lines;
}

/// The reference beside the heads: steps of the heads are told from its own noise by nobody.
nlohmann::json ReferenceJson(const SeveralHeads& heads) {
  nlohmann::json json = CurveJson(heads.reference, "ez");
  json["u_parts"] = report::PartsJson({{"noise", 1.0}});
  return json;
}

nlohmann::json HeadsSeparationJson(const SeveralHeads& heads, const DeviceSettings& settings) {
  const double of_white = StepShare(heads.residual_rms_rad, settings);
  const double of_steps = heads.rounding_share + (1.0 - heads.rounding_share) * of_white;
  nlohmann::json harmonics = {{"form", "sum of amplitude cos(order angle + phase)"},
                              {"highest_order", heads.Highest()},
                              {"device", OrdersJson(heads.ring, heads.ring_by_noise, of_steps)}};
  nlohmann::json json = {{"device", RingJson(heads, of_steps)},
                         {"not_separable", NotSeparableOf(heads)},
                         {"lost", LostJson(heads)},
                         {"residual_rms",
                          {{"head_arcsec", report::Arcsec(heads.residual_rms_rad)},
                           {"reference_arcsec", report::Arcsec(heads.reference_rms_rad)}}},
                         {"stops", heads.stops},
                         {"dof", report::In(1.0, heads.dof)}};
  for (const double head_rad : heads.heads_rad) json["heads_deg"].push_back(WrittenNumber(head_rad, units::deg));
  if (!heads.reference.orders.empty()) {
    json["reference"] = ReferenceJson(heads);
    harmonics["reference"] = OrdersJson(heads.reference, heads.reference, 0.0);
  }
  json["harmonics"] = harmonics;
  return json;
}

std::string LostOrdersText(const SeveralHeads& heads, const AxisUnit& unit) {
  const WholeCurve whole = WholeOf(heads);
  std::string text = fmt::format("curve of the ring      U = {:.4f} {} (k = 2, root mean square over the turn)\n",
                                 2.0 * whole.u_rad / unit.to_SI, unit.name);
  if (heads.lost.orders.empty()) return text;
  text += fmt::format("not seen by the heads, orders {}: {}\n", OrdersText(heads.lost.orders), kAllSeeTheSame);
  return text + fmt::format("with these, if they fall as 1 / order beside their neighbours: U = {:.4f} {}\n",
                            2.0 * whole.u_whole_rad / unit.to_SI, unit.name);
}

std::string HeadsSummary(const SeveralHeads& heads, const AxisUnit& unit) {
  if (!heads.not_separated.empty()) return fmt::format("no curve: {}\n", heads.not_separated);
  std::string text = fmt::format("{} heads at {} measuring positions\n", heads.heads_rad.size(), heads.stops);
  text += LargestText("ring", heads.ring, unit) + LargestText("reference", heads.reference, unit);
  text += fmt::format("a head repeats to      {:10.4f} {} (standard deviation)\n",
                      heads.residual_rms_rad / unit.to_SI, unit.name);
  if (std::isfinite(heads.reference_rms_rad))
    text += fmt::format("the reference to       {:10.4f} {}\n", heads.reference_rms_rad / unit.to_SI, unit.name);
  text += UnresolvedText(heads.ring, unit) + LostOrdersText(heads, unit);
  for (const std::string& note : heads.notes) text += "note: " + note + "\n";
  return text;
}

}  // namespace

report::Evaluation EvaluateHeads(const Scenario& scenario, const std::vector<Reading>& readings,
                                 Estimator estimator) {
  const measure::AngleComparison comparison = measure::CompareAngles(readings);
  const SeveralHeads heads = Calibrated(scenario, readings, estimator);
  const DeviceSettings device = DeviceOfMeans(EncoderOf(scenario));
  report::Evaluation evaluation{
      ToJson(comparison), {}, heads.not_separated, Summary(comparison, CoarseUnit(device))};
  evaluation.results["estimator"] = EstimatorName(estimator);
  evaluation.summary += HeadsSummary(heads, FineUnit(device));
  if (!heads.not_separated.empty()) {
    evaluation.results["not_separated"] = heads.not_separated;
    return evaluation;
  }
  AddCalibration(HeadsSeparationJson(heads, device), heads.notes, evaluation);
  return evaluation;
}

report::ScoredRun ScoreHeads(const Scenario& scenario, const std::vector<Reading>& readings,
                             const nlohmann::json& truth, Estimator estimator) {
  const SeveralHeads heads = Calibrated(scenario, readings, estimator);
  if (!heads.not_separated.empty())
    throw InputError("the run", heads.not_separated, "a run with two heads or more over a whole turn");
  nlohmann::json device = truth.at("device"), reference = truth.at("reference");
  const double lost_arcsec = report::TakeOutOrders(heads.lost.orders, device);
  report::TakeOutOrders(heads.lost.orders, reference);
  std::vector<report::CurveScore> curves = {ScoreOf("device", heads.ring, device)};
  if (!heads.reference.orders.empty()) curves.push_back(ScoreOf("reference", heads.reference, reference));
  nlohmann::json json = report::ToJson(curves);
  json["lost"] = {{"orders", heads.lost.orders},
                  {"rms_arcsec", lost_arcsec},
                  {"assumed_rms_arcsec", report::Arcsec(heads.lost.assumed_rad)}};
  std::string text = "against the truth, without the orders that no head sees\n" + report::ScoreTable(curves);
  if (!heads.lost.orders.empty())
    text += fmt::format("orders {} had {:.4f} arcsec (root mean square), {:.4f} were assumed\n",
                        OrdersText(heads.lost.orders), lost_arcsec, heads.lost.assumed_rad / units::arcsec);
  return {json, text, report::PositionTable(curves), report::ValuesOf(curves)};
}

}  // namespace twinbench::benches::encoder
