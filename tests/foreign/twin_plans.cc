#include <fmt/format.h>

#include <map>
#include <memory>

#include "tests/foreign/plans.h"
#include "tests/hidden/effect_size.h"
#include "tests/hidden/placements.h"
#include "tests/hidden/twin_case.h"
#include "twin/benches/names.h"

namespace twinbench::foreign {
namespace {

using hidden::Placement;
using hidden::SignatureScale;

/// Effects that another run shows otherwise.
bool IsRandom(const std::string& effect) {
  return effect == "outliers" || effect == "multitooth_seating";
}

std::vector<Placement> RepeatingPlacements(const std::string& bench) {
  std::vector<Placement> kept;
  for (const Placement& at : hidden::Placements(bench)) {
    if (!IsRandom(at.effect) && hidden::HasSize(at.effect, at.where, bench)) kept.push_back(at);
  }
  return kept;
}

/// The machine of a twin: the second run has other tables, another room and other dwells.
Machine MakeTwinMachine(const Placement& at, std::uint64_t seed, const SignatureScale& scale) {
  constexpr double kRho = 60.0;
  const hidden::Case made = hidden::MakeTwinCase(at.design, seed, {{at.effect, at.where, kRho}}, scale);
  std::vector<EffectSettings> effects;
  for (const hidden::Part& part : made.hidden.causes)
    effects.push_back({part.effect, part.where, part.parameters, ""});
  Truth truth;
  truth.kind = at.effect + (at.where.empty() ? "" : " " + at.where);
  truth.listed = {{at.effect}};
  truth.listed.front().insert(truth.listed.front().end(), made.hidden.alike.begin(), made.hidden.alike.end());
  const auto readings = [=, first = made.readings](const Run& run) {
    if (run.noise) return first;
    return hidden::NoiseFree(hidden::Drawn(at.design, seed + run.seed),
                             run.faults ? effects : std::vector<EffectSettings>{});
  };
  return {truth, made.scenario, readings};
}

}  // namespace

std::vector<Plan> TwinPlans(int each, std::uint64_t first_seed, const std::string& cache_folder) {
  std::vector<Plan> plans;
  std::uint64_t seed = 3000000 + first_seed;
  for (const char* bench : {kTurntableBench, kHobBench, kCircularBench, kFreeformBench}) {
    const std::vector<Placement> places = RepeatingPlacements(bench);
    std::map<hidden::Design, std::shared_ptr<const SignatureScale>> scales;
    for (const Placement& at : places)
      scales.try_emplace(at.design, std::make_shared<const SignatureScale>(at.design, cache_folder));
    for (int k = 0; k < each; ++k) {
      const Placement at = places[static_cast<std::size_t>(k) * places.size() / static_cast<std::size_t>(each)];
      seed += 10;
      plans.push_back({std::string("twins ") + bench, hidden::CaseName(at, seed),
                       [at, seed, scale = scales.at(at.design)] { return MakeTwinMachine(at, seed, *scale); }});
    }
  }
  return plans;
}

}  // namespace twinbench::foreign
