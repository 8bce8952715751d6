#include "twin/benches/encoder_comparison/curve_results.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "twin/benches/encoder_comparison/estimators/device_error.h"
#include "twin/report/json_units.h"

namespace twinbench::benches::encoder {

using separate::encoder::Curve;
using separate::encoder::CurveAt;
using separate::harmonics::Coefficient;
using separate::harmonics::HarmonicSeries;

nlohmann::json CurveJson(const HarmonicSeries& series, const std::string& name) {
  const CurveAt curve = Curve(series, kCurvePoints);
  nlohmann::json json;
  for (int i = 0; i < kCurvePoints; ++i) {
    json["position_deg"].push_back(i * 360.0 / kCurvePoints);
    json[name + "_arcsec"].push_back(report::Arcsec(curve.value_rad[i]));
    json["u_" + name + "_arcsec"].push_back(report::Arcsec(curve.u_rad[i]));
  }
  if (series.unresolved_rad2 > 0.0)
    json["unresolved"] = {{"above_order", series.Highest()},
                          {"assumed_rms_arcsec", report::Arcsec(std::sqrt(series.unresolved_rad2))},
                          {"assumption", "the amplitude of an order falls as 1 / order above those that are seen"}};
  return json;
}

std::string UnresolvedText(const HarmonicSeries& series, const AxisUnit& unit) {
  if (!(series.unresolved_rad2 > 0.0)) return "";
  return fmt::format(
      "orders above {}: {:.4g} {} (rms), as far as the readings show them or as they fall by 1 / order; in no curve, counted in u\n",
      series.Highest(), std::sqrt(series.unresolved_rad2) / unit.to_SI, unit.name);
}

void AddCalibration(nlohmann::json separation, const std::vector<std::string>& notes, report::Evaluation& evaluation) {
  evaluation.separation = std::move(separation);
  evaluation.results.update(evaluation.separation);
  evaluation.results["notes"] = notes;
  for (const char* key : {"not_separable", "dof"})
    evaluation.results["separation"][key] = evaluation.separation.at(key);
}

nlohmann::json HarmonicsJson(const HarmonicSeries& series) {
  nlohmann::json json = nlohmann::json::array();
  for (int k = 1; k <= series.Highest(); ++k) {
    const Coefficient& c = series.At(k);
    if (!std::isfinite(c.value.real())) continue;
    json.push_back({{"order", k},
                    {"amplitude_arcsec", report::Arcsec(Amplitude(c))},
                    {"u_amplitude_arcsec", report::Arcsec(AmplitudeUncertainty(c))},
                    {"phase_deg", report::In(units::deg, separate::harmonics::Phase(c))},
                    {"u_phase_deg", report::In(units::deg, PhaseUncertainty(c))}});
  }
  return json;
}

std::string LinesText(const char* what, const HarmonicSeries& series, const AxisUnit& unit) {
  std::string text;
  for (const int order : FindLines(series)) {
    const Coefficient& c = series.At(order);
    text += fmt::format("{:<10} order {:2d}    {:10.3f} ± {:.3f} {}, phase {:+.2f} deg\n", what, order,
                        Amplitude(c) / unit.to_SI, AmplitudeUncertainty(c) / unit.to_SI, unit.name,
                        separate::harmonics::Phase(c) / units::deg);
  }
  return text;
}

std::string LargestText(const char* what, const HarmonicSeries& series, const AxisUnit& unit) {
  constexpr std::size_t kMost = 6;
  std::vector<int> orders = FindLines(series);
  const auto size = [&](int order) { return -Amplitude(series.At(order)); };
  std::ranges::sort(orders, {}, size);
  std::string text;
  for (std::size_t i = 0; i < std::min(kMost, orders.size()); ++i) {
    const Coefficient& c = series.At(orders[i]);
    text += fmt::format("{:<10} order {:3d}   {:10.4f} ± {:.4f} {}, phase {:+.2f} deg\n", what, orders[i],
                        Amplitude(c) / unit.to_SI, AmplitudeUncertainty(c) / unit.to_SI, unit.name,
                        separate::harmonics::Phase(c) / units::deg);
  }
  if (orders.size() > kMost)
    text += fmt::format("{:<10} and {} more orders that stand out of the noise\n", what, orders.size() - kMost);
  return text;
}

report::CurveScore ScoreOf(const std::string& name, const HarmonicSeries& series, const nlohmann::json& truth) {
  report::CurveScore curve{.name = name,
                           .value = "ez_arcsec",
                           .position = truth.at("position_deg"),
                           .estimate = {},
                           .u = {},
                           .truth = truth.at("ez_arcsec")};
  curve.dof = series.dof;
  const CurveAt at = Curve(series, static_cast<int>(curve.position.size()));
  for (Eigen::Index i = 0; i < at.value_rad.size(); ++i) {
    curve.estimate.push_back(at.value_rad[i] / units::arcsec);
    curve.u.push_back(at.u_rad[i] / units::arcsec);
  }
  return curve;
}

}  // namespace twinbench::benches::encoder
