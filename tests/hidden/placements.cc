#include "tests/hidden/placements.h"

#include <fmt/format.h>

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

}  // namespace twinbench::hidden
