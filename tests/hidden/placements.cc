#include "tests/hidden/placements.h"

#include <fmt/format.h>

#include <algorithm>

#include "tests/hidden/effect_size.h"
#include "twin/benches/names.h"
#include "twin/core/effect_catalogue.h"

namespace twinbench::hidden {
namespace {

std::vector<std::string> PlacesOf(const EffectEntry& entry) {
  return entry.places.empty() ? std::vector<std::string>{""} : entry.places;
}

bool NeedsAllKnown(const std::string& effect) {
  return effect == "interpolation" || effect == "gear_mesh" || effect == "reference_fault";
}

/// Effects that a circle cannot tell from errors of the tables, which are free: controls_test.cc.
bool IsTheTables(const std::string& effect) {
  return effect == "grating_form" || effect == "encoder_subdivision";
}

/// Designs that can show an effect at all: a device at rest is not late, and one that is read
/// once a stop does not show how it comes to rest.
std::vector<Design> DesignsFor(const std::string& effect, const std::string& bench) {
  if (bench == kRotaryBench) return IsTheTables(effect) ? std::vector<Design>{} : std::vector{Design::kRotary};
  if (bench == kTurntableBench) return {Design::kTurntable};
  if (bench == kHobBench) return {Design::kHob};
  if (bench == kCircularBench) return {Design::kCircles};
  if (bench == kFreeformBench) return {Design::kFreeform};
  if (effect == "settling") return {};
  if (effect == "zero_temperature") return {Design::kStopsInWarmRoom};
  if (effect == "latency" || effect == "clock_rate") return {Design::kSweep};
  if (NeedsAllKnown(effect)) return {Design::kStopsAllKnown, Design::kSweepAllKnown};
  return {Design::kStops, Design::kSweep};
}

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
  EffectSettings gap = WithDefaults("backlash", "", drawn.bench);
  gap.parameters["width"] = 2.0 * effect.parameters.at("lag");
  if (gap.parameters["width"] < CatalogueParameter(drawn.bench, "backlash", "width").lower_SI) return false;
  return scale.Rho(NoiseFree(drawn, {effect}), NoiseFree(drawn, {gap}), drawn.seed) < kTellable;
}

}  // namespace

std::vector<Placement> Placements(const std::string& bench) {
  std::vector<Placement> placements;
  for (const EffectEntry& entry : EffectCatalogue(bench)) {
    for (const std::string& place : PlacesOf(entry)) {
      for (const Design design : DesignsFor(entry.name, bench)) placements.push_back({entry.name, place, design});
    }
  }
  return placements;
}

std::vector<Design> PlainDesigns(const std::string& bench) {
  return DesignsFor("", bench);
}

std::string CaseName(const Placement& placement, std::uint64_t seed) {
  return fmt::format("{}:{}:{}:{}", NamesOf(placement.design).name, placement.effect, placement.where, seed);
}

std::vector<std::string> AlikeOf(const EffectSettings& effect, const Scenario& drawn, const SignatureScale& scale) {
  std::vector<std::string> alike = AlikeByShape(effect.name);
  if (IsLikeAGap(effect, drawn, scale)) alike.push_back("backlash");
  return alike;
}

bool OnlyRelabels(const std::string& where) {
  return where == "reverse_target" || where == "reverse_reference" || where == "index_offset";
}

}  // namespace twinbench::hidden
