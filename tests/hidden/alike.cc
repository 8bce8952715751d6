#include "tests/hidden/alike.h"

#include <algorithm>

#include "tests/hidden/effect_size.h"

namespace twinbench::hidden {
namespace {

/// Signatures of one shape: both axes of a detector too short or too long; on the angle bench, errors of one order.
std::vector<std::string> AlikeByShape(const std::string& effect) {
  const std::vector<std::vector<std::string>> sets = {{"psd_distance", "stray_light", "background"},
                                                      {"eccentricity", "signal_offset", "tilt"},
                                                      {"bar_gain", "bar_nonlinearity"},
                                                      {"focal_length", "spot_size"},
                                                      {"qpd_gain", "leakage"},
                                                      {"interpolation", "gear_mesh", "periodic"},
                                                      {"ellipticity", "amplitude_mismatch", "quadrature_error"}};
  for (const auto& set : sets) {
    if (std::ranges::find(set, effect) != set.end()) return set;
  }
  if (effect == "backlash") return {"backlash", "hysteresis"};  // that settles at once
  return {effect};
}

/// A hysteresis that settles within so few readings that no test would tell it from a gap of twice its lag.
bool IsLikeAGap(const EffectSettings& effect, const Scenario& drawn, const SignatureScale& scale) {
  constexpr double kTellable = 4.13;  // found in 80 % of cases at a test of 0.1 %
  if (effect.name != "hysteresis") return false;
  EffectSettings gap;
  gap.name = "backlash";
  for (const EffectParameter& p : FindEffect("backlash", drawn.bench)->parameters)
    gap.parameters[p.name] = p.default_SI;
  gap.parameters["width"] = 2.0 * effect.parameters.at("lag");
  if (gap.parameters["width"] < CatalogueParameter(drawn.bench, "backlash", "width").lower_SI) return false;
  return scale.Rho(NoiseFree(drawn, {effect}), NoiseFree(drawn, {gap}), drawn.seed) < kTellable;
}

}  // namespace

std::vector<std::string> AlikeOf(const EffectSettings& effect, const Scenario& drawn, const SignatureScale& scale) {
  std::vector<std::string> alike = AlikeByShape(effect.name);
  if (IsLikeAGap(effect, drawn, scale)) alike.push_back("backlash");
  return alike;
}

bool OnlyRelabels(const std::string& where) {
  return where == "reverse_target" || where == "reverse_reference" || where == "index_offset";
}

}  // namespace twinbench::hidden
