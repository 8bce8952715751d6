#include <algorithm>

#include "tests/foreign/dice.h"
#include "tests/foreign/plans.h"
#include "tests/hidden/alike.h"
#include "tests/hidden/another_run.h"
#include "tests/hidden/effect_size.h"
#include "tests/hidden/placements.h"
#include "tests/hidden/twin_case.h"
#include "twin/core/happened_once.h"

namespace twinbench::foreign {
namespace {

using hidden::Placement, hidden::SignatureScale;

/// Effects that another run shows again.
bool Repeats(const Placement& at, const std::string& bench) {
  const bool is_random = at.effect == "outliers" || at.effect == "multitooth_seating";
  const auto happens_once = [](const EffectParameter& p) { return p.name == kHappenedAt; };
  return !is_random && hidden::HasSize(at.effect, at.where, bench) &&
         std::ranges::none_of(FindEffect(at.effect, bench)->parameters, happens_once);
}

std::vector<Placement> RepeatingPlacements(const std::string& bench) {
  std::vector<Placement> placements = hidden::Placements(bench);
  std::erase_if(placements, [&](const Placement& at) { return !Repeats(at, bench); });
  return placements;
}

Truth TruthOf(const Placement& at, const std::vector<std::string>& alike) {
  Truth truth;
  truth.kind = at.effect + (at.where.empty() ? "" : " " + at.where);
  truth.listed = {Names{truth.kind}};
  for (const std::string& effect : alike) {
    if (effect != at.effect) truth.listed.front().push_back(effect);
  }
  return truth;
}

/// The machine of a twin, whose other run is on another day.
Machine MakeTwinMachine(const Placement& at, std::uint64_t seed, const SignatureScale& scale) {
  const double rho = Dice(seed, "size").Sized(15.0, 60.0);
  const Scenario actual = hidden::HiddenBench(at.design, seed, {{at.effect, at.where, rho}}, scale);
  const Truth truth = TruthOf(at, hidden::AlikeOf(actual.effects.front(), hidden::Drawn(at.design, seed), scale));
  const auto readings = [actual](const Run& run) {
    Scenario asked = run.seed == kFirst.seed ? actual : hidden::OnAnotherDay(actual);
    asked.noise_free = !run.noise;
    if (!run.faults) asked.effects.clear();
    return hidden::TakeReadings(asked);
  };
  return {truth, hidden::Believed(at.design), readings, hidden::WithOtherSchedule};
}

}  // namespace

std::vector<Plan> TwinPlans(const std::string& bench, int count, std::uint64_t first_seed) {
  const std::vector<Placement> places = RepeatingPlacements(bench);
  std::vector<Plan> plans;
  std::uint64_t seed = 3000000 + first_seed;
  for (int k = 0; k < count; ++k) {
    const Placement at = places[static_cast<std::size_t>(k) * places.size() / static_cast<std::size_t>(count)];
    seed += 10;
    plans.push_back({"twins " + bench, hidden::CaseName(at, seed),
                     [at, seed] { return MakeTwinMachine(at, seed, hidden::ScaleOf(at.design)); }});
  }
  return plans;
}

}  // namespace twinbench::foreign
