#include "twin/report/curve_score.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "twin/report/spoken_keys.h"

namespace twinbench::report {
namespace {

/// Root mean square of the finite values; NaN if there is none.
double RmsOfFinite(const std::vector<double>& values) {
  double sum = 0.0;
  int count = 0;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    sum += value * value;
    ++count;
  }
  return count > 0 ? std::sqrt(sum / count) : std::numeric_limits<double>::quiet_NaN();
}

struct Sizes {
  double rms_truth, rms_error, worst_error, rms_u, mean_chi2;
};

Sizes SizesOf(const CurveScore& curve) {
  std::vector<double> error, normalised;
  double worst = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t k = 0; k < curve.truth.size(); ++k) {
    error.push_back(curve.estimate[k] - curve.truth[k]);
    normalised.push_back(error.back() / curve.u[k]);
    worst = std::fmax(worst, std::abs(error.back()));
  }
  return {RmsOfFinite(curve.truth), RmsOfFinite(error), worst, RmsOfFinite(curve.u), std::pow(RmsOfFinite(normalised), 2)};
}

/// "ez_arcsec": "ez" and "_arcsec".
std::string Quantity(const CurveScore& curve) {
  return curve.value.substr(0, curve.value.rfind('_'));
}
std::string UnitSuffix(const CurveScore& curve) {
  return curve.value.substr(curve.value.rfind('_'));
}

}  // namespace

std::string ScoreTable(const std::vector<CurveScore>& curves) {
  const auto cell = [](double value, int width, int decimals) {
    return std::isfinite(value) ? fmt::format("{:{}.{}f}", value, width, decimals) : fmt::format("{:>{}}", "-", width);
  };
  std::size_t width = 16;
  for (const CurveScore& curve : curves) width = std::max(width, WithWords(curve.name).size());
  std::string text = fmt::format("{:{}}  value         truth rms  error rms  worst error  stated u  (error/u)^2\n", "curve", width);
  for (const CurveScore& curve : curves) {
    const Sizes s = SizesOf(curve);
    text += fmt::format("{:{}}  {:12}  {}  {}  {}  {}  {}\n", WithWords(curve.name), width, curve.value, cell(s.rms_truth, 9, 4),
                        cell(s.rms_error, 9, 4), cell(s.worst_error, 11, 4), cell(s.rms_u, 8, 4), cell(s.mean_chi2, 11, 3));
  }
  return text;
}

std::string PositionTable(const std::vector<CurveScore>& curves) {
  std::string text;
  for (const CurveScore& curve : curves) {
    text += fmt::format("{}: estimate ± standard uncertainty [truth]\n{:>12} {:>27}\n", curve.name,
                        curve.position_name, curve.value);
    for (std::size_t k = 0; k < curve.truth.size(); ++k)
      text += fmt::format("{:12.2f}   {:8.3f} ±{:6.3f} [{:6.2f}]\n", curve.position[k], curve.estimate[k],
                          curve.u[k], curve.truth[k]);
  }
  return text;
}

nlohmann::json ToJson(const std::vector<CurveScore>& curves) {
  nlohmann::json json = nlohmann::json::object();
  for (const CurveScore& curve : curves) {
    const Sizes s = SizesOf(curve);
    const std::string unit = UnitSuffix(curve);
    json[curve.name][Quantity(curve)] = {{"positions", curve.truth.size()}, {"rms_truth" + unit, s.rms_truth},
                                         {"rms_error" + unit, s.rms_error}, {"worst_error" + unit, s.worst_error},
                                         {"rms_u" + unit, s.rms_u},         {"mean_chi2", s.mean_chi2}};
  }
  return json;
}

std::vector<ScoredValue> ValuesOf(const std::vector<CurveScore>& curves) {
  std::vector<ScoredValue> values;
  for (const CurveScore& curve : curves) {
    for (std::size_t k = 0; k < curve.truth.size(); ++k)
      values.push_back({fmt::format("{}.{}[{}]", curve.name, curve.value, k), curve.estimate[k], curve.u[k],
                        curve.truth[k], curve.dof});
  }
  return values;
}

}  // namespace twinbench::report
