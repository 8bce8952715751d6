#include "tests/foreign/plans.h"

#include "tests/hidden/twin_cases.h"
#include "twin/core/happened_once.h"

namespace twinbench::foreign {
namespace {

constexpr std::uint64_t kApart = 100;  // runs of a machine take the seeds behind it

const std::string kAngleSet = "encoder_comparison", kStandSet = "rotary_4dof";

bool Suits(const AngleKind& kind, bool in_motion) {
  return kind.where == Where::kBoth || (kind.where == Where::kMotion) == in_motion;
}

Plan AngleKindPlan(const AngleKind& kind, bool in_motion, std::uint64_t seed) {
  return {"kinds " + kAngleSet, fmt::format("{} {} {}", kind.name, in_motion ? "motion" : "stops", seed), [=] {
            return MakeAngleMachine(seed, in_motion, {{kind, Dice(seed, "size").Sized(15.0, 150.0)}});
          }};
}

Plan StandKindPlan(const StandKind& kind, std::uint64_t seed) {
  return {"kinds " + kStandSet, fmt::format("{} {}", kind.name, seed), [=] {
            return MakeStand(seed, {{kind, Dice(seed, "size").Sized(25.0, 150.0)}});
          }};
}

/// Kinds of which no two are the same, and those that are there besides.
template <class Kind>
std::vector<Wanted<Kind>> Mixture(const std::vector<Kind>& listed, const std::vector<Kind>& unlisted,
                                  double least_rho, Dice& dice) {
  std::vector<Kind> left = listed;
  std::vector<Wanted<Kind>> wanted;
  const bool has_unlisted = dice.Sign() > 0.0;
  for (int count = dice.Whole(has_unlisted ? 1 : 2, has_unlisted ? 2 : 3); count > 0; --count) {
    const auto k = static_cast<std::size_t>(dice.Whole(0, static_cast<int>(left.size()) - 1));
    wanted.push_back({left[k], dice.Sized(1.5 * least_rho, 5.0 * least_rho)});
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(k));
  }
  if (has_unlisted) wanted.push_back({dice.OneOf(unlisted), dice.Sized(least_rho, 2.0 * least_rho)});
  return wanted;
}

/// What is only noise or hardly ever of a size that shows beside others is no part of a mixture.
template <class Kind>
std::vector<Kind> Without(std::vector<Kind> kinds, const std::vector<std::string>& names) {
  std::erase_if(kinds, [&](const Kind& kind) { return std::ranges::find(names, kind.name) != names.end(); });
  return kinds;
}

Machine MakeAngleMixture(std::uint64_t seed) {
  Dice dice(seed, "mixture");
  const bool in_motion = dice.Sign() > 0.0;
  const auto suiting = [&](std::vector<AngleKind> kinds) {
    std::erase_if(kinds, [&](const AngleKind& kind) { return !Suits(kind, in_motion); });
    return kinds;
  };
  const auto others = Without(suiting(UnlistedAngleKinds()), {"noise of speed", "1/f noise", "held readings"});
  return MakeAngleMachine(seed, in_motion, Mixture(suiting(ListedAngleKinds()), others, 15.0, dice));
}

Machine MakeStandMixture(std::uint64_t seed) {
  Dice dice(seed, "mixture");
  const auto others = Without(UnlistedStandKinds(), {"noise of spot", "both distances"});
  return MakeStand(seed, Mixture(ListedStandKinds(), others, 25.0, dice));
}

/// Every stress, and plain noise as often, with the positions in turn.
struct CleanDesign {
  NoiseShape noise;
  int positions;
};

CleanDesign CleanOf(int k, const std::vector<int>& positions) {
  static const std::vector<NoiseShape> stresses = Stresses();
  const auto turn = static_cast<std::size_t>(k / 2);
  if (k % 2 == 0) return {stresses[turn % stresses.size()], 0};
  const int n = positions[turn % positions.size()];
  return {{fmt::format("{} positions", n)}, n};
}

Plan AngleCleanPlan(int k, std::uint64_t seed) {
  const CleanDesign design = CleanOf(k / 2, {8, 12, 20, 36, 72, 120, 180, 360});
  // Positions are those of stops.
  const bool in_motion = design.positions == 0 && k % 2 == 1;
  return {"clean " + kAngleSet, fmt::format("{} {} {}", design.noise.name, in_motion ? "motion" : "stops", seed),
          [=] { return MakeAngleInOrder(seed, in_motion, design.noise, design.positions); }};
}

Plan StandCleanPlan(int k, std::uint64_t seed) {
  const CleanDesign design = CleanOf(k, {8, 12, 24});
  const int positions = design.positions == 0 ? 36 : design.positions;
  return {"clean " + kStandSet, fmt::format("{} {}", design.noise.name, seed),
          [=] { return MakeStandInOrder(seed, design.noise, positions); }};
}

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

std::vector<Plan> KindPlans(int each, std::uint64_t first_seed) {
  std::vector<Plan> plans;
  std::uint64_t seed = first_seed;
  for (const AngleKind& kind : UnlistedAngleKinds()) {
    for (int k = 0; k < each; ++k) {
      seed += kApart;
      const bool in_motion = Suits(kind, (seed / kApart) % 2 == 0) == ((seed / kApart) % 2 == 0);
      plans.push_back(AngleKindPlan(kind, in_motion, seed));
    }
  }
  for (const StandKind& kind : UnlistedStandKinds()) {
    for (int k = 0; k < each; ++k) plans.push_back(StandKindPlan(kind, seed += kApart));
  }
  return plans;
}

std::vector<Plan> SeveralPlans(int count, std::uint64_t first_seed) {
  std::vector<Plan> plans;
  for (int k = 0; k < count; ++k) {
    const std::uint64_t seed = 1000000 + first_seed + kApart * static_cast<std::uint64_t>(k);
    const bool is_stand = k % 7 == 2 || k % 7 == 5;
    plans.push_back({"several " + (is_stand ? kStandSet : kAngleSet), fmt::format("several {}", seed),
                     [=] { return is_stand ? MakeStandMixture(seed) : MakeAngleMixture(seed); }});
  }
  return plans;
}

std::vector<Plan> CleanPlans(int count, std::uint64_t first_seed) {
  std::vector<Plan> plans;
  for (int k = 0; k < count; ++k) {
    const std::uint64_t seed = 2000000 + first_seed + kApart * static_cast<std::uint64_t>(k);
    plans.push_back(k % 4 == 3 ? StandCleanPlan(k / 4, seed) : AngleCleanPlan(k - k / 4, seed));
  }
  return plans;
}

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
