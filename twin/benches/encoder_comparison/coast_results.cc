#include "twin/benches/encoder_comparison/parts_of_results.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>

#include "twin/benches/encoder_comparison/curve_results.h"
#include "twin/benches/encoder_comparison/estimators/device_error.h"
#include "twin/benches/encoder_comparison/estimators/time_reversal.h"
#include "twin/benches/encoder_comparison/uncertainty_parts.h"
#include "twin/core/errors.h"
#include "twin/report/json_units.h"

namespace twinbench::benches::encoder {
namespace {

using separate::encoder::TimeReversal;

TimeReversal Timed(const std::vector<Reading>& readings, Estimator estimator) {
  return estimator == Estimator::kPublished ? separate::encoder::DynamicReversal(readings)
                                            : separate::encoder::SeparateByTime(readings);
}

double CurveRms_rad(const TimeReversal& timed) {
  const Eigen::VectorXd u_rad = separate::encoder::Curve(timed.ring, 360).u_rad;
  return std::sqrt(u_rad.squaredNorm() / static_cast<double>(u_rad.size()));
}

/// Orders that the noise of the times alone makes uncertain.
nlohmann::json OrdersByNoiseJson(const separate::harmonics::HarmonicSeries& series) {
  nlohmann::json lines = HarmonicsJson(series);
  AddPublishedOrderParts(series, series, 0.0, lines);
  return lines;
}

nlohmann::json CoastRingJson(const TimeReversal& timed) {
  nlohmann::json json = CurveJson(timed.ring, "ez");
  json["u_parts"] = PublishedCurveParts(timed.ring, timed.ring_by_noise, 0.0, kCurvePoints);
  return json;
}

nlohmann::json CoastHarmonicsJson(const TimeReversal& timed) {
  nlohmann::json json = {{"form", "sum of amplitude cos(order angle + phase)"},
                         {"highest_order", timed.ring.Highest()},
                         {"device", HarmonicsJson(timed.ring)}};
  AddPublishedOrderParts(timed.ring, timed.ring_by_noise, 0.0, json["device"]);
  if (!timed.torque.orders.empty()) json["torque"] = OrdersByNoiseJson(timed.torque);
  if (!timed.friction.orders.empty()) json["friction"] = OrdersByNoiseJson(timed.friction);
  return json;
}

nlohmann::json CoastSeparationJson(const TimeReversal& timed) {
  return {{"device", CoastRingJson(timed)},
          {"harmonics", CoastHarmonicsJson(timed)},
          {"reference_speed_deg_s", report::In(units::deg, timed.reference_speed_rad_s)},
          {"stamp_noise_ns", report::In(1e-9, timed.stamp_noise_s)},
          {"curve_rms_u_arcsec", report::Arcsec(CurveRms_rad(timed))},
          {"not_separable", timed.not_separable},
          {"turns", timed.turns},
          {"lines", timed.lines},
          {"dof", report::In(1.0, timed.dof)}};
}

std::string CoastSummary(const TimeReversal& timed, int readings, const AxisUnit& unit) {
  std::string text = fmt::format("{} times of lines", readings);
  text += timed.left_out > 0 ? fmt::format(", {} without a value\n", timed.left_out) : "\n";
  if (!timed.not_separated.empty()) return text + fmt::format("no curve: {}\n", timed.not_separated);
  text += fmt::format("{} whole turns of {} lines in {} passes\n", timed.turns, timed.lines, timed.passes);
  text += LargestText("ring", timed.ring, unit) + LargestText("torque", timed.torque, unit) +
          LargestText("friction", timed.friction, unit);
  if (!timed.torque.orders.empty())
    text += fmt::format("torque and friction: how far they move the shaft at {:.4g} deg/s\n",
                        timed.reference_speed_rad_s / units::deg);
  text += fmt::format("a time repeats to      {:10.4f} ns (standard deviation)\n", timed.stamp_noise_s / 1e-9);
  text += fmt::format("curve of the ring      U = {:.4f} {} (k = 2, {} orders, root mean square over the turn)\n",
                      2.0 * CurveRms_rad(timed) / unit.to_SI, unit.name, timed.ring.Highest());
  for (const std::string& lost : timed.not_separable) text += "not separable: " + lost + "\n";
  for (const std::string& note : timed.notes) text += "note: " + note + "\n";
  return text;
}

}  // namespace

report::Evaluation EvaluateCoast(const Scenario& scenario, const std::vector<Reading>& readings,
                                 Estimator estimator) {
  const TimeReversal timed = Timed(readings, estimator);
  report::Evaluation evaluation{{{"readings", readings.size()}, {"estimator", EstimatorName(estimator)}},
                                {},
                                timed.not_separated,
                                CoastSummary(timed, static_cast<int>(readings.size()),
                                             FineUnit(EncoderOf(scenario).device))};
  if (!timed.not_separated.empty()) {
    evaluation.results["not_separated"] = timed.not_separated;
    return evaluation;
  }
  AddCalibration(CoastSeparationJson(timed), timed.notes, evaluation);
  return evaluation;
}

report::ScoredRun ScoreCoast(const std::vector<Reading>& readings, const nlohmann::json& truth,
                             Estimator estimator) {
  const TimeReversal timed = Timed(readings, estimator);
  if (!timed.not_separated.empty())
    throw InputError("the run", timed.not_separated, "passes of four turns or more with the times of all lines");
  std::vector<report::CurveScore> curves = {ScoreOf("device", timed.ring, truth.at("device"))};
  // Orders that are a multiple of the positions' count are a constant there, which the truth has lost.
  std::vector<double>& estimate = curves.front().estimate;
  const double mean = std::accumulate(estimate.begin(), estimate.end(), 0.0) / static_cast<double>(estimate.size());
  for (double& value : estimate) value -= mean;
  return {report::ToJson(curves), "against the truth; means are taken out of both\n" + report::ScoreTable(curves),
          report::PositionTable(curves), report::ValuesOf(curves)};
}

}  // namespace twinbench::benches::encoder
