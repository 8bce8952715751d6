#include "twin/report/error_motion_json.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "twin/core/units.h"
#include "twin/report/json_units.h"
#include "twin/report/uncertainty_parts.h"

namespace twinbench::report {
namespace {

using separate::ErrorMotionValue;
using separate::ErrorMotionValues;
using Shares = std::vector<std::pair<std::string, double>>;

constexpr const char* kTurnsApart = "repeatability";

double UnitOfMotion(const DirectedMotion& d) {
  return d.is_angle ? units::arcsec : units::um;
}

nlohmann::json MotionValueJson(const ErrorMotionValue& v, const DirectedMotion& d, const Shares& shares) {
  const std::string unit = d.is_angle ? "arcsec" : "um";
  nlohmann::json json = {{"value_" + unit, In(UnitOfMotion(d), v.value)}, {"u_" + unit, In(UnitOfMotion(d), v.u)}, {"bias_" + unit, In(UnitOfMotion(d), v.bias)}};
  if (std::isfinite(v.u) && v.u > 0.0) json["u_parts"] = PartsJson(shares);
  return json;
}

/// How much of the uncertainty of the contour's width is whose: as of its largest and smallest point. The last part takes what is left.
Shares SharesOfContour(const DirectedMotion& d, const ErrorMotionValues& values) {
  Shares shares;
  const double all = d.motion.cov.size() > 0 ? values.slope.dot(d.motion.cov * values.slope) : 0.0;
  double left = 1.0;
  for (const auto& [name, part] : d.parts) {
    const bool is_last = shares.size() + 1 == d.parts.size();
    const double share = is_last ? left : std::min(left, all > 0.0 ? std::clamp(values.slope.dot(part * values.slope) / all, 0.0, 1.0) : 0.0);
    shares.emplace_back(name, share);
    left -= share;
  }
  return shares;
}

/// Those of the contour as far as it goes into a value, and the scatter of the turns.
Shares WithTurns(Shares shares, double of_contour) {
  for (auto& [name, share] : shares) share *= of_contour;
  const auto own = std::ranges::find(shares, kTurnsApart, &std::pair<std::string, double>::first);
  if (own != shares.end()) {
    own->second += 1.0 - of_contour;
  } else {
    shares.emplace_back(kTurnsApart, 1.0 - of_contour);
  }
  return shares;
}

nlohmann::json MotionValuesJson(const DirectedMotion& d, const ErrorMotionValues& values) {
  const Shares contour = SharesOfContour(d, values);
  nlohmann::json json = {{"synchronous", MotionValueJson(values.synchronous, d, contour)}};
  for (const auto& [name, value] : {std::pair{"fundamental", values.fundamental}, std::pair{"residual", values.residual}})
    if (std::isfinite(value.value)) json[name] = MotionValueJson(value, d, contour);
  if (std::isnan(values.total.value)) return json;
  json["total"] = MotionValueJson(values.total, d, WithTurns(contour, std::min(1.0, std::pow(values.synchronous.u / values.total.u, 2))));
  if (std::isfinite(values.asynchronous.value)) json["asynchronous"] = MotionValueJson(values.asynchronous, d, {{kTurnsApart, 1.0}});
  return json;
}

std::string MotionText(const DirectedMotion& d, const ErrorMotionValues& values) {
  std::string words = d.name;
  std::ranges::replace(words, '_', ' ');
  std::string text = fmt::format("  {:18}", words);
  const auto add = [&](const char* name, const ErrorMotionValue& v) {
    if (std::isnan(v.value)) return;
    text += fmt::format(" {} {:.3f}", name, v.value / UnitOfMotion(d));
    if (std::isfinite(v.u)) text += fmt::format(" ± {:.3f}", v.u / UnitOfMotion(d));
  };
  add("synchronous", values.synchronous);
  add("asynchronous", values.asynchronous);
  add("total", values.total);
  add("fundamental", values.fundamental);
  add("residual", values.residual);
  return text + (d.is_angle ? " arcsec\n" : " um\n");
}

}  // namespace

void AppendErrorMotions(const std::string& table, const std::vector<DirectedMotion>& directions, const std::vector<std::string>& missing,
                        separate::ErrorMotionDraws& draws, ErrorMotionTexts& to) {
  if (!directions.empty()) to.text += fmt::format("ISO 230-7, {}\n", table);
  for (const DirectedMotion& d : directions) {
    const ErrorMotionValues values = EvaluateErrorMotion(d.motion, d.centre, draws);
    if (std::isnan(values.synchronous.value)) continue;
    to.json.push_back({{"table", table}, {"motion", d.name}, {"values", MotionValuesJson(d, values)}, {"missing", missing}});
    if (std::isfinite(d.dof)) to.json.back()["dof"] = d.dof;
    if (values.turns > 0) to.json.back()["turns"] = values.turns;
    to.text += MotionText(d, values);
  }
}

}  // namespace twinbench::report
