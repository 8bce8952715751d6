#include <fmt/core.h>

#include <cmath>
#include <complex>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "twin/benches/hob_transmission/bench.h"
#include "twin/benches/hob_transmission/estimators/hob_bench.h"
#include "twin/core/errors.h"
#include "twin/report/curve_score.h"

namespace twinbench::benches::hob {
namespace {

using separate::hob::AnalyseHob;
using separate::hob::Coefficient;
using separate::hob::DirectionResult;
using separate::hob::HarmonicSeries;
using separate::hob::HobAnalysis;
using separate::hob::OrderStatus;
using separate::hob::SeparatedOrder;

/// Coefficients A exp(j phase) of each order, cosine convention.
/// @param ahead_rad  Of the angle that the table has, what errs so is at that angle and this.
std::map<int, std::complex<double>> TruthOf(const nlohmann::json& harmonics, double ahead_rad = 0.0) {
  std::map<int, std::complex<double>> truth;
  for (const nlohmann::json& h : harmonics) {
    const double order = h.at("order").get<double>();
    if (order != std::floor(order)) continue;
    truth[static_cast<int>(order)] +=
        std::polar(h.at("amplitude_arcsec").get<double>(), h.at("phase_deg").get<double>() * units::deg + order * ahead_rad);
  }
  return truth;
}

/// Real and imaginary part of each order as two rows.
/// @param lost  Orders that the design does not separate: the estimate still has the encoder's share in it.
report::CurveScore CurveOf(const std::string& name, const HarmonicSeries& series,
                           const std::map<int, std::complex<double>>& truth, const std::set<int>& lost = {}) {
  report::CurveScore curve;
  curve.name = name;
  curve.value = "amplitude_arcsec";
  curve.position_name = "order";
  curve.dof = series.dof;
  const auto add = [&](int order, double estimate_rad, double variance, double true_arcsec) {
    curve.position.push_back(order);
    curve.estimate.push_back(estimate_rad / units::arcsec);
    curve.u.push_back(std::sqrt(variance) / units::arcsec);
    curve.truth.push_back(true_arcsec);
  };
  for (int k = 1; k <= series.Highest(); ++k) {
    const Coefficient& c = series.At(k);
    if (!std::isfinite(c.value.real()) || lost.contains(k)) continue;
    const auto found = truth.find(k);
    const std::complex<double> true_value = found == truth.end() ? 0.0 : found->second;
    add(k, c.value.real(), c.cov(0, 0), true_value.real());
    add(k, c.value.imag(), c.cov(1, 1), true_value.imag());
  }
  return curve;
}

/// The order with which bodies swing by more than half the uncertainty of an order: the transmission that is read is that of this speed, and no truth
/// of slow turning judges it.
std::optional<double> SwingsAt(const report::CurveScore& curve, const nlohmann::json& harmonics) {
  constexpr double kPart = 0.5;
  double sum = 0.0;
  for (const double u : curve.u) sum += u;
  const double u_arcsec = sum / static_cast<double>(curve.u.size());
  for (const nlohmann::json& h : harmonics)
    if (h.value("swing_arcsec", 0.0) > kPart * u_arcsec) return h.at("order").get<double>();
  return std::nullopt;
}

}  // namespace

report::ScoredRun ScoreOf(const HobAnalysis& analysis, const nlohmann::json& truth) {
  if (!analysis.separation) throw InputError("the run", analysis.not_separated, "a run with complete turns");
  const auto encoder = TruthOf(truth.at("table_encoder"));
  const double ahead_rad = truth.value("gears_ahead_deg", 0.0) * units::deg;
  std::set<int> lost;
  for (const SeparatedOrder& order : analysis.separation->orders)
    if (order.status == OrderStatus::kSumOnly) lost.insert(order.order);
  std::vector<report::CurveScore> curves;
  std::string swings;
  for (const DirectionResult& direction : analysis.directions) {
    const std::string name = fmt::format("transmission {:+d}", direction.direction);
    const auto transmission = TruthOf(truth.at("transmission"), direction.direction * ahead_rad);
    curves.push_back(CurveOf(name, direction.transmission, transmission, lost));
    if (const std::optional<double> order = SwingsAt(curves.back(), truth.at("transmission"))) {
      swings += fmt::format("{}: not scored, at this speed its bodies swing with order {:g}; truth is of slow turning\n", name, *order);
      curves.pop_back();
    }
  }
  curves.push_back(CurveOf("table encoder", analysis.encoder, encoder));
  if (analysis.two_positions) {
    HarmonicSeries first;
    first.orders = {analysis.two_positions->encoder};
    first.dof = analysis.separation->dof;
    curves.push_back(CurveOf("two positions", first, encoder));
  }
  if (analysis.is_interferometer_at_rest)
    curves.push_back(CurveOf("interferometer at rest", analysis.encoder_by_interferometer, encoder));
  return {ToJson(curves),
          "against the truth: both parts of every order that is separable\n" + report::ScoreTable(curves) + swings,
          report::PositionTable(curves), report::ValuesOf(curves)};
}

report::ScoredRun ScoreRun(const Scenario& scenario, const std::vector<Reading>& readings,
                           const nlohmann::json& truth, Estimator estimator) {
  return ScoreOf(AnalyseHob(readings, scenario, estimator), truth);
}

}  // namespace twinbench::benches::hob
