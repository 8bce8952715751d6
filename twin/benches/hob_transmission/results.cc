#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "twin/benches/hob_transmission/bench.h"
#include "twin/benches/hob_transmission/estimators/hob_bench.h"
#include "twin/benches/hob_transmission/uncertainty_parts.h"
#include "twin/report/compensation_text.h"
#include "twin/report/far_readings.h"
#include "twin/report/json_units.h"
#include "twin/separate/far_on_course.h"

namespace twinbench::benches::hob {
namespace {

using separate::hob::Amplitude;
using separate::hob::AmplitudeUncertainty;
using separate::hob::AnalyseHob;
using separate::hob::Coefficient;
using separate::hob::DirectionResult;
using separate::hob::HarmonicSeries;
using separate::hob::HobAnalysis;
using separate::hob::HobOrder;
using separate::hob::OrderComparison;
using separate::hob::OrderStatus;
using separate::hob::Phase;
using separate::hob::PhaseUncertainty;
using separate::hob::PositionError;
using separate::hob::PositionStatus;
using separate::hob::SeparatedOrder;

/// Columns, one entry an order.
nlohmann::json ToJson(const HarmonicSeries& series) {
  nlohmann::json json = {{"form", "sum of amplitude cos(order angle + phase)"}};
  for (int k = 1; k <= series.Highest(); ++k) {
    const Coefficient& c = series.At(k);
    json["order"].push_back(k);
    json["amplitude_arcsec"].push_back(report::Arcsec(Amplitude(c)));
    json["u_amplitude_arcsec"].push_back(report::Arcsec(AmplitudeUncertainty(c)));
    json["phase_deg"].push_back(report::In(units::deg, separate::hob::Phase(c)));
    json["u_phase_deg"].push_back(report::In(units::deg, PhaseUncertainty(c)));
  }
  return json;
}

nlohmann::json ToJson(const std::vector<OrderComparison>& comparisons, const ComparedParts& parts) {
  nlohmann::json json = nlohmann::json::array();
  for (const OrderComparison& c : comparisons) {
    json.push_back({{"order", c.order},
                    {"separated", c.status == OrderStatus::kSeparated},
                    {"amplitude_arcsec", report::Arcsec(Amplitude(c.estimated))},
                    {"reference_arcsec", report::Arcsec(Amplitude(c.reference))},
                    {"amplitude_difference_arcsec", report::Arcsec(c.amplitude_difference_rad)},
                    {"u_amplitude_difference_arcsec", report::Arcsec(c.u_amplitude_difference_rad)},
                    {"phase_difference_rad", report::In(1.0, c.phase_difference_rad)},
                    {"u_phase_difference_rad", report::In(1.0, c.u_phase_difference_rad)},
                    {"normalised_error", report::In(1.0, c.normalised_error)},
                    {"u_parts", PartsOf(c, parts)}});
  }
  return json;
}

constexpr double kCountsNothing_rad2 = 0.0;

/// Positions with turns, of one direction or (0) of both.
std::vector<const PositionError*> UsedOf(const std::vector<PositionError>& positions, int direction) {
  std::vector<const PositionError*> used;
  for (const PositionError& p : positions) {
    if (p.status == PositionStatus::kOk && (direction == 0 || p.direction == direction)) used.push_back(&p);
  }
  return used;
}

nlohmann::json ToJson(const DirectionResult& result, const HobAnalysis& a, const HobSettings& settings) {
  nlohmann::json json = ToJson(result.transmission);
  json["u_parts"] = PartsOf(UsedOf(a.positions, result.direction), StepVariance_rad2(settings, false), true);
  json["direction"] = result.direction;
  json["lines"] = result.lines;
  for (const HobOrder& order : result.of_hob)
    json["of_hob"].push_back({{"order", order.times * settings.transmission.HobOrder()},
                              {"per_turn_of_hob", order.times},
                              {"amplitude_arcsec", report::Arcsec(Amplitude(order.wave))},
                              {"u_amplitude_arcsec", report::Arcsec(AmplitudeUncertainty(order.wave))},
                              {"phase_deg", report::In(units::deg, separate::hob::Phase(order.wave))},
                              {"u_phase_deg", report::In(units::deg, PhaseUncertainty(order.wave))}});
  if (result.against_interferometer.empty()) return json;
  const nlohmann::json by_interferometer =
      PartsOf(UsedOf(a.transmission_by_interferometer, result.direction), kCountsNothing_rad2, false);
  json["against_interferometer"] = ToJson(result.against_interferometer, {json["u_parts"], by_interferometer});
  return json;
}

nlohmann::json ToJson(const PositionError& p, const HobSettings& settings) {
  nlohmann::json json = ToJson(p.series);
  if (p.status == PositionStatus::kOk) json["u_parts"] = PartsOf({&p}, StepVariance_rad2(settings, false), false);
  json.update({{"setup", p.setup},
               {"direction", p.direction},
               {"head_deg", p.head_rad / units::deg},
               {"turns", p.turns},
               {"turns_left_out", p.turns_left_out},
               {"samples", p.samples},
               {"residual_rms_arcsec", report::Arcsec(p.residual_rms_rad)},
               {"drift_arcsec_per_turn", report::Arcsec(p.drift_rad_per_turn)}});
  return json;
}

/// Samples a turn of those whose orders fold; none: nothing.
std::optional<int> FoldingSamples(const HobAnalysis& a) {
  const auto folds =
      std::ranges::find_if(a.positions, [](const PositionError& p) { return p.of_folding_rad2 > 0.0; });
  if (folds == a.positions.end()) return std::nullopt;
  return folds->samples / folds->turns;
}

nlohmann::json NotSeparable(const HobAnalysis& a) {
  nlohmann::json lost = nlohmann::json::array();
  for (const SeparatedOrder& order : a.separation->orders) {
    if (order.status != OrderStatus::kSumOnly) continue;
    const auto folded = a.folded.find(order.order);
    const std::string why = folded == a.folded.end()
                                ? "the heads see this order alike"
                                : fmt::format("the samples of a turn show order {} so", folded->second);
    lost.push_back({{"what", fmt::format("transmission and table encoder, order {}", order.order)},
                    {"why", why + "; the sum is counted as the transmission's"},
                    {"noise_factor", report::In(1.0, order.noise_factor)}});
  }
  if (const auto samples = FoldingSamples(a))
    lost.push_back(
        {{"what", fmt::format("orders k and {} - k", *samples)},
         {"why", fmt::format("{} samples per turn show them as one; u has what the turns leave", *samples)}});
  return lost;
}

nlohmann::json TwoPositionsJson(const separate::hob::TwoPositions& two, const nlohmann::json& parts) {
  const auto order_1 = [](const Coefficient& c) {
    return nlohmann::json{{"amplitude_arcsec", report::Arcsec(Amplitude(c))},
                          {"u_amplitude_arcsec", report::Arcsec(AmplitudeUncertainty(c))},
                          {"phase_rad", report::In(1.0, Phase(c))},
                          {"u_phase_rad", report::In(1.0, PhaseUncertainty(c))}};
  };
  return {{"noise_factor", report::In(1.0, two.noise_factor)},
          {"table_encoder_order_1", order_1(two.encoder)},
          {"transmission_order_1", order_1(two.transmission)},
          {"u_parts", PartsOfOrder(parts, 1)}};
}

/// rms of what the turns' fits left over, over all positions.
double ResidualRms_rad(const HobAnalysis& a) {
  double sum = 0.0;
  int samples = 0;
  for (const PositionError& p : a.positions) {
    if (p.status != PositionStatus::kOk) continue;
    sum += p.samples * p.residual_rms_rad * p.residual_rms_rad;
    samples += p.samples;
  }
  return samples > 0 ? std::sqrt(sum / samples) : kNaN;
}

nlohmann::json SeparationJson(const HobAnalysis& a, const HobSettings& settings) {
  nlohmann::json json = {{"estimator", EstimatorName(a.estimator)},
                         {"transmission", nlohmann::json::array()},
                         {"table_encoder", ToJson(a.encoder)},
                         {"not_separable", NotSeparable(a)},
                         {"residual_rms", {{"sample_arcsec", report::Arcsec(ResidualRms_rad(a))}}},
                         {"dof", report::In(1.0, a.separation->dof)}};
  json["table_encoder"]["u_parts"] = PartsOf(UsedOf(a.positions, 0), StepVariance_rad2(settings, false), true);
  for (const DirectionResult& direction : a.directions)
    json["transmission"].push_back(ToJson(direction, a, settings));
  if (a.two_positions)
    json["two_positions"] = TwoPositionsJson(*a.two_positions, PartsOf(separate::hob::FirstTwoOf(a.positions),
                                                                       StepVariance_rad2(settings, false), false));
  return json;
}

void AddInterferometer(const HobAnalysis& a, const HobSettings& settings, nlohmann::json& json) {
  const auto parts_of = [&](const std::vector<PositionError>& positions, const HarmonicSeries& mean) {
    return WithStandard(
        PartsOf(UsedOf(positions, 0), StepVariance_rad2(settings, a.is_interferometer_at_rest), false), mean,
        settings.interferometer.u_calibrator_rad, a.encoder_rounding_rad2);
  };
  const nlohmann::json of_heads = json["separation"]["table_encoder"]["u_parts"],
                       of_all = parts_of(a.by_interferometer, a.encoder_by_interferometer);
  json["table_encoder_by_interferometer"] = ToJson(a.encoder_by_interferometer);
  json["table_encoder_by_interferometer"]["u_parts"] = of_all;
  json["table_encoder_against_interferometer"] = ToJson(a.encoder_against_interferometer, {of_heads, of_all});
  if (a.is_interferometer_at_rest) return;
  json["table_encoder_against_one_place"] =
      ToJson(a.encoder_against_one_place, {of_heads, parts_of(a.by_one_place, a.encoder_by_one_place)});
}

nlohmann::json ResultsOf(const HobAnalysis& a, const HobSettings& settings) {
  nlohmann::json json = {{"readings", a.used}, {"left_out", a.left_out}, {"positions", nlohmann::json::array()}};
  for (const PositionError& position : a.positions) json["positions"].push_back(ToJson(position, settings));
  if (!a.separation) {
    json["not_separated"] = a.not_separated;
    return json;
  }
  json["separation"] = SeparationJson(a, settings);
  if (!a.encoder_by_interferometer.orders.empty()) {
    json["interferometer"] = a.is_interferometer_at_rest ? "at_rest" : "in_motion";
    AddInterferometer(a, settings, json);
  }
  return json;
}

std::string PositionText(const PositionError& p) {
  if (p.status != PositionStatus::kOk)
    return fmt::format("head at {:6.2f} deg, direction {:+d}: no complete turn\n", p.head_rad / units::deg,
                       p.direction);
  const Coefficient& first = p.series.At(1);
  return fmt::format(
      "head at {:6.2f} deg, direction {:+d}   order 1: {:.2f} ± {:.2f} arcsec ({} turns, {} samples)\n",
      p.head_rad / units::deg, p.direction, Amplitude(first) / units::arcsec,
      AmplitudeUncertainty(first) / units::arcsec, p.turns, p.samples);
}

std::string OrderText(const char* what, const Coefficient& c) {
  return fmt::format("{}   {:.2f} ± {:.2f} arcsec, phase {:.3f} ± {:.3f} rad\n", what,
                     Amplitude(c) / units::arcsec, AmplitudeUncertainty(c) / units::arcsec, Phase(c),
                     PhaseUncertainty(c));
}

/// @param folded  Orders as which the samples show a higher one.
std::string LinesText(const DirectionResult& result, const HobSettings& settings, const std::map<int, int>& folded) {
  std::string text = fmt::format("transmission, direction {:+d}: lines at order", result.direction);
  if (result.lines.empty() && result.of_hob.empty()) return text + " none\n";
  for (const int order : result.lines) {
    const double amplitude_arcsec = Amplitude(result.transmission.At(order)) / units::arcsec;
    const auto higher = folded.find(order);
    text += fmt::format(" {}{} ({:.2f})", order, higher == folded.end() ? "" : fmt::format(" or {}", higher->second), amplitude_arcsec);
  }
  for (const HobOrder& order : result.of_hob) {
    text += fmt::format(" {:.6g} ({:.2f} ± {:.2f}, {} per turn of the hob)", order.times * settings.transmission.HobOrder(),
                        Amplitude(order.wave) / units::arcsec, AmplitudeUncertainty(order.wave) / units::arcsec, order.times);
  }
  return text + " [arcsec]\n";
}

std::string ComparisonText(const char* with, const std::vector<OrderComparison>& comparisons) {
  std::string text;
  constexpr double kWorthTelling = 5.0;  // of less than so many uncertainties the phase says nothing
  for (const OrderComparison& c : comparisons) {
    if (!(Amplitude(c.reference) > kWorthTelling * AmplitudeUncertainty(c.estimated))) continue;
    text += fmt::format("table encoder against the interferometer{}, order {}: {:+.2f} arcsec, {:+.3f} rad\n", with,
                        c.order, c.amplitude_difference_rad / units::arcsec, c.phase_difference_rad);
  }
  return text;
}

std::string LostText(const HobAnalysis& a) {
  std::vector<int> orders;
  for (const SeparatedOrder& order : a.separation->orders) {
    if (order.status == OrderStatus::kSumOnly) orders.push_back(order.order);
  }
  std::string text;
  if (!orders.empty())
    text += fmt::format("not separable, counted as transmission: {}\n", report::OrderRanges(orders));
  if (const auto samples = FoldingSamples(a))
    text += fmt::format("not separable, counted in u: orders k and {0} - k, as {0} samples per turn show them\n",
                        *samples);
  if (std::isfinite(a.encoder.At(1).value.real()) && separate::hob::FindLines(a.encoder).empty())
    text += "doubtful: the table encoder shows no order; was its head moved between the mountings?\n";
  return text;
}

std::string SummaryOf(const HobAnalysis& a, const HobSettings& settings) {
  std::string text = fmt::format("{} samples", a.used);
  text += a.left_out > 0 ? fmt::format(", {} left out\n", a.left_out) : "\n";
  for (const PositionError& position : a.positions) text += PositionText(position);
  if (!a.separation) return text + fmt::format("no separation: {}\n", a.not_separated);
  const bool published = a.estimator == Estimator::kPublished && a.two_positions;
  const bool separated = a.separation->At(1).status == OrderStatus::kSeparated;
  if (published) text += OrderText("table encoder, order 1, two positions", a.two_positions->encoder);
  if (!published && separated) text += OrderText("table encoder, order 1", a.encoder.At(1));
  if (a.is_interferometer_at_rest)
    text += OrderText("table encoder, order 1, by the interferometer at rest", a.encoder_by_interferometer.At(1));
  for (const DirectionResult& direction : a.directions) text += LinesText(direction, settings, a.folded);
  return text + ComparisonText(a.is_interferometer_at_rest ? " at rest" : "", a.encoder_against_interferometer) +
         ComparisonText(" with the first head alone", a.encoder_against_one_place) + LostText(a);
}

/// Single samples that no other turn of the table shows are as good as missing. Of one turn alone none is told from a fault of the gears.
std::vector<separate::FarOnCourse> TakeOutFar(double ratio, std::vector<Reading>& readings) {
  constexpr double kLeast_rad = 1e-12;
  const auto error = [ratio](const Reading& r) {
    const separate::OnCourse at{r.reading, r.measured_rad, r.measured_rad - ratio * r.reference_rad};
    return r.velocity_rad_s != 0.0 ? std::optional(at) : std::nullopt;
  };
  return separate::TakeOutFar(readings, error, kLeast_rad, [](double, double) { return true; });
}

/// Of all orders together, of e_T + psi.
report::Misfit MisfitOf(const separate::hob::HeadSeparation& separation) {
  double chi2 = 0.0;
  int dof = 0;
  for (const SeparatedOrder& order : separation.orders) {
    if (order.dof <= 0 || !std::isfinite(order.chi2)) continue;
    chi2 += order.chi2;
    dof += order.dof;
  }
  return {"the separation of transmission and table encoder", std::sqrt(chi2 / dof)};
}

}  // namespace

report::Evaluation Evaluate(const Scenario& scenario, const std::vector<Reading>& all_readings, Estimator estimator) {
  const HobSettings& settings = HobOf(scenario);
  std::vector<Reading> readings = all_readings;
  const std::vector<separate::FarOnCourse> far = TakeOutFar(settings.transmission.Ratio(), readings);
  const HobAnalysis analysis = AnalyseHob(readings, scenario, estimator);
  const nlohmann::json separation = analysis.separation ? SeparationJson(analysis, settings) : nlohmann::json();
  report::Evaluation evaluation{ResultsOf(analysis, settings), separation, analysis.not_separated, report::FarText(far, "reading {} (table at {:.6g} deg)", "arcsec", units::arcsec) + SummaryOf(analysis, settings)};
  if (!far.empty()) evaluation.results["far"] = report::FarJson(far, "off_arcsec", units::arcsec);
  if (analysis.separation) evaluation.misfits = {MisfitOf(*analysis.separation)};
  evaluation.score = [analysis](const nlohmann::json& truth) { return ScoreOf(analysis, truth); };
  return evaluation;
}

}  // namespace twinbench::benches::hob
