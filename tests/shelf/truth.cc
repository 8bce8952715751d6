#include <complex>
#include <fstream>

#include "tests/shelf/judge.h"
#include "twin/core/errors.h"
#include "twin/core/units.h"

namespace twinbench::shelf {
namespace {

using nlohmann::json;

/// A key that is misspelt would quietly ask for nothing.
void CheckKeys(const json& object, const std::vector<std::string>& known, const std::string& where) {
  for (const auto& [key, value] : object.items()) {
    if (std::ranges::find(known, key) == known.end())
      throw InputError(where, "has a key \"" + key + "\"", "one of judge.h");
  }
}

Expected ExpectedOf(const json& cause, const std::string& where) {
  CheckKeys(
      cause,
      {"effects", "words", "order", "parameter", "size", "unit", "others", "at", "over_s", "share", "approximate"},
      where);
  Expected expected;
  expected.effects = cause.value("effects", expected.effects);
  expected.words = cause.value("words", expected.words);
  expected.order = cause.value("order", kNaN);
  expected.parameter = cause.value("parameter", "");
  expected.size = cause.value("size", kNaN);
  expected.unit = cause.value("unit", "");
  expected.others = cause.value("others", expected.others);
  expected.at_deg = cause.value("at", kNaN);
  expected.over_s = cause.value("over_s", kNaN);
  expected.share = cause.value("share", 0.0);
  expected.approximate = cause.value("approximate", false);
  return expected;
}

void AddBesides(const json& besides, const std::string& where, Truth& truth) {
  CheckKeys(besides, {"orders", "any_order_below", "effects", "words", "rest"}, where);
  truth.orders = besides.value("orders", truth.orders);
  truth.any_order_below_deg = besides.value("any_order_below", 0.0);
  truth.effects = besides.value("effects", truth.effects);
  truth.words = besides.value("words", truth.words);
  truth.has_rest = besides.value("rest", false);
}

using diagnose::Cause, diagnose::ParameterEstimate;

const ParameterEstimate* ParameterOf(const Cause& cause, const std::string& name) {
  const auto found = std::ranges::find(cause.parameters, name, &ParameterEstimate::name);
  return found == cause.parameters.end() || !std::isfinite(found->value) ? nullptr : &*found;
}

double ValueOf(const Cause& cause, const std::string& name, double otherwise) {
  const ParameterEstimate* p = ParameterOf(cause, name);
  return p ? p->value : otherwise;
}

std::optional<Size> Told(const Cause& cause, const std::string& name, const std::string& kind,
                         double factor = 1.0) {
  const ParameterEstimate* p = ParameterOf(cause, name);
  if (!p) return {};
  return Size{factor * std::abs(p->value), factor * p->u, kind};
}

/// Of an order of the angle that signals give which are cut off at `level`, by the discrete Fourier transform of
/// one turn.
double AmplitudeOfClipping(double level, double order) {
  constexpr int kSamples = 4096;
  std::complex<double> sum = 0.0;
  for (int i = 0; i < kSamples; ++i) {
    const double angle = units::turn * (i + 0.5) / kSamples;
    const double error =
        std::atan2(std::clamp(std::sin(angle), -level, level), std::clamp(std::cos(angle), -level, level)) - angle;
    sum += std::remainder(error, units::turn) * std::polar(1.0, -order * angle);
  }
  return 2.0 * std::abs(sum) / kSamples;
}

std::optional<Size> SizeOfScale(const Cause& cause, const Expected& expected) {
  if (!expected.parameter.empty()) return Told(cause, expected.parameter, "ratio");
  std::optional<Size> size = Told(cause, "ratio", "ratio");
  if (size && std::isfinite(expected.at_deg))  // the slope of (ratio + curvature * turns) * angle
    size->value =
        std::abs(ValueOf(cause, "ratio", 0.0) + 2.0 * ValueOf(cause, "curvature", 0.0) * expected.at_deg / 360.0);
  return size;
}

/// As the twin has it (twin/benches/encoder_comparison/twin/effects/drift.cc).
std::optional<Size> SizeOfDrift(const Cause& cause, double over_s) {
  if (!std::isfinite(over_s)) return Told(cause, "rate", "rate");
  std::optional<Size> size = Told(cause, "rate", "angle", over_s);
  if (!size) return size;
  const double warm_up_s = ValueOf(cause, "warm_up", 0.0);
  const double grown = warm_up_s > 0.0 ? -std::expm1(-over_s / warm_up_s) * warm_up_s / over_s
                                       : 1.0 + ValueOf(cause, "curvature", 0.0) * (1.0 - over_s / units::hour);
  return Size{std::abs(grown) * size->value, std::abs(grown) * size->u, "angle"};
}

}  // namespace

Truth ReadTruth(const std::string& path, const std::string& name) {
  std::ifstream in(path);
  const json all = json::parse(in, nullptr, false);
  if (!all.is_object() || !all.contains(name))
    throw InputError(path, "has no case " + name, "every file of the folder");
  const json& one = all.at(name);
  const std::string where = path + ", " + name;
  CheckKeys(one, {"causes", "besides", "nothing_else"}, where);
  Truth truth;
  for (const json& cause : one.at("causes")) truth.causes.push_back(ExpectedOf(cause, where));
  if (one.contains("besides")) AddBesides(one.at("besides"), where, truth);
  truth.nothing_else = one.value("nothing_else", false);
  return truth;
}

Size InSI(double size, const std::string& unit) {
  const std::map<std::string, std::pair<double, std::string>> units = {
      {"deg", {units::deg, "angle"}}, {"mm", {units::deg, "angle"}}, {"arcsec", {units::arcsec, "angle"}},
      {"s", {1.0, "time"}},           {"1", {1.0, "ratio"}},         {"deg/h", {units::deg / units::hour, "rate"}}};
  const auto found = units.find(unit);
  if (found == units.end())
    throw InputError("truth.json", "has the unit \"" + unit + "\"", "deg, mm, arcsec, s, 1 or deg/h");
  return {size * found->second.first, 0.0, found->second.second};
}

bool IsSameOrder(double a, double b) { return std::abs(a - b) <= std::max(0.05, 0.01 * std::abs(b)); }

double OrderOf(const Cause& cause) {
  const std::map<std::string, double> fixed = {{"eccentricity", 1.0},     {"signal_offset", 1.0},
                                               {"ellipticity", 2.0},      {"amplitude_mismatch", 2.0},
                                               {"quadrature_error", 2.0}, {"signal_clipping", 4.0}};
  const auto found = fixed.find(cause.effect);
  if (found != fixed.end()) return found->second;  // one period of the signals a turn: nobody says another number
  return ValueOf(cause, cause.effect == "gear_mesh" ? "teeth" : "order", kNaN);
}

std::optional<Size> AmplitudeOf(const Cause& cause, double order) {
  if (cause.effect == "signal_clipping") {
    const ParameterEstimate* level = ParameterOf(cause, "level");
    if (!level || std::abs(std::remainder(order, 4.0)) > 1e-9) return {};
    return Size{AmplitudeOfClipping(level->value, order), 0.0, "angle"};
  }
  if (!IsSameOrder(OrderOf(cause), order)) return {};
  if (cause.effect == "signal_offset") {
    const std::optional<Size> sine = Told(cause, "offset_sin", "angle"),
                              cosine = Told(cause, "offset_cos", "angle");
    if (!sine || !cosine) return {};
    return Size{std::hypot(sine->value, cosine->value), std::hypot(sine->u, cosine->u), "angle"};
  }
  if (cause.effect == "amplitude_mismatch") return Told(cause, "ratio", "angle", 0.5);
  if (cause.effect == "quadrature_error") return Told(cause, "angle", "angle", 0.5);
  return Told(cause, "amplitude", "angle");
}

std::optional<Size> AmplitudeTogether(const std::vector<Cause>& causes, double order) {
  std::complex<double> sum = 0.0;
  double u2 = 0.0;
  int pieces = 0;
  for (const Cause& cause : causes) {
    const ParameterEstimate *amplitude = ParameterOf(cause, "amplitude"), *phase = ParameterOf(cause, "phase");
    if (!amplitude || !phase || !IsSameOrder(OrderOf(cause), order)) continue;
    sum += std::polar(1.0, phase->value) * amplitude->value;
    u2 += amplitude->u * amplitude->u;
    ++pieces;
  }
  if (pieces < 2) return {};
  return Size{std::abs(sum), std::sqrt(u2), "angle"};
}

/// In steady motion a lag of first order is as late as a delay.
std::optional<Size> Lateness(const Cause& cause) {
  const std::optional<Size> delay = Told(cause, "delay", "time"), lag = Told(cause, "time_constant", "time");
  if (!delay || !lag) return delay;
  const auto known = [](double u) { return std::isfinite(u) ? u : 0.0; };
  return Size{delay->value + lag->value, std::hypot(known(delay->u), known(lag->u)), "time"};
}

std::optional<Size> SizeOf(const Cause& cause, const Expected& expected) {
  if (std::isfinite(expected.order)) return AmplitudeOf(cause, expected.order);
  if (cause.effect == "scale") return SizeOfScale(cause, expected);
  if (cause.effect == "drift") return SizeOfDrift(cause, expected.over_s);
  if (cause.effect == "latency") return Lateness(cause);
  if (cause.effect == "backlash") return Told(cause, "width", "angle");
  if (cause.effect == "hysteresis") return Told(cause, "lag", "angle", 2.0);  // it lags in either sense
  if (cause.effect == "slip") return Told(cause, "step", "angle");
  return {};
}

}  // namespace twinbench::shelf
