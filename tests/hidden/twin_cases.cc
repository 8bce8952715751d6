#include "tests/hidden/twin_cases.h"

#include "twin/benches/names.h"
#include "twin/benches/rotary_4dof/settings.h"
#include "twin/benches/turntable_autocollimator/settings.h"

namespace twinbench::hidden {
namespace {

/// How many sizes an effect is hidden with: a swap has but one.
int MagnitudesOf(const Placement& at, const std::string& bench, const TwinOptions& options) {
  const bool comes_in_sizes =
      HasSize(at.effect, at.where, bench) || at.effect == "outliers" || at.effect == "multitooth_seating";
  return comes_in_sizes ? options.magnitudes : 1;
}

Plan SinglePlan(const std::string& set, const Placement& at, double rho, std::uint64_t seed) {
  const Wanted wanted{at.effect, at.where, rho};
  return {set, CaseName(at, seed),
          [wanted, seed, design = at.design] { return MakeTwinCase(design, seed, {wanted}, ScaleOf(design)); }};
}

Case WithoutItsCause(Case made) {
  constexpr int kNullRuns = 200;  // at rho 20 the alarm is no question
  made.options.excluded = {made.hidden.causes.front().effect};
  made.options.null_runs = kNullRuns;
  return made;
}

/// What a pair is drawn from.
std::vector<Wanted> SizedEffects(const std::string& bench) {
  std::vector<Wanted> effects;
  for (const Placement& at : Placements(bench)) {
    if (HasSize(at.effect, at.where, bench)) effects.push_back({at.effect, at.where});
  }
  return effects;
}

Wanted AnyOf(const std::vector<Wanted>& all, Stream& stream) {
  return all[static_cast<std::size_t>(stream.Uniform() * static_cast<double>(all.size()))];
}

std::vector<Wanted> DrawPair(const std::vector<Wanted>& all, double rho_to, Stream& stream) {
  Wanted a, b;
  do {
    a = AnyOf(all, stream);
    b = AnyOf(all, stream);
  } while (a.effect == b.effect);
  a.rho = LogUniformIn(stream, 10.0, rho_to);
  b.rho = LogUniformIn(stream, 10.0, rho_to);
  return {a, b};
}

double& Remount_s(Scenario& scenario) {
  return scenario.bench == kRotaryBench ? RotaryOf(scenario).procedure.remount_s
                                        : TurntableOf(scenario).turntable_procedure.remount_s;
}

std::vector<EffectSettings> DrawEffects(const std::vector<Wanted>& wanted, const Scenario& drawn,
                                        const SignatureScale& scale) {
  Stream stream(drawn.seed, "hidden.effect");
  std::vector<EffectSettings> effects;
  for (const Wanted& w : wanted) {
    EffectSettings effect = DrawEffect(w.effect, w.where, drawn, stream);
    for (const auto& [name, value] : w.parameters) effect.parameters.at(name) = value;
    effects.push_back(HasSize(w.effect, w.where, drawn.bench) ? SizedTo(w.rho, effect, drawn, scale) : effect);
  }
  return effects;
}

Hidden TruthOf(const std::vector<EffectSettings>& effects) {
  Hidden hidden;
  for (const EffectSettings& e : effects) hidden.causes.push_back({e.name, e.where, e.parameters});
  hidden.invisible = OnlyRelabels(effects.front().where);
  return hidden;
}

std::vector<std::string> PlacesOf(const EffectEntry& entry) {
  return entry.places.empty() ? std::vector<std::string>{""} : entry.places;
}

bool NeedsAllKnown(const std::string& effect) {
  return effect == "interpolation" || effect == "gear_mesh" || effect == "reference_fault";
}

/// Effects that a circle cannot tell from errors of the tables, which are free: controls_test.cc.
bool IsTheTables(const std::string& effect) { return effect == "grating_form" || effect == "encoder_subdivision"; }

/// Designs that can show an effect at all: a device at rest is not late, and one that is read
/// once a stop does not show how it comes to rest.
std::vector<Design> DesignsFor(const std::string& effect, const std::string& bench) {
  if (bench == kRotaryBench) return IsTheTables(effect) ? std::vector<Design>{} : std::vector{Design::kRotary};
  if (bench == kTurntableBench) return {Design::kTurntable};
  if (bench == kHobBench) return {Design::kHob};
  if (bench == kCircularBench) return {Design::kCircles};
  if (bench == kFreeformBench) return {Design::kFreeform};
  if (effect == "settling") return {};
  if (effect == "acceleration_error" || effect == "friction") return {};  // of a servo that rests between its ways
  if (effect == "zero_temperature" || effect == "scale_temperature") return {Design::kStopsInWarmRoom};
  if (effect == "latency" || effect == "clock_rate") return {Design::kSweep};
  if (NeedsAllKnown(effect)) return {Design::kStopsAllKnown, Design::kSweepAllKnown};
  return {Design::kStops, Design::kSweep};
}

/// Signatures of one shape: both axes of a detector too short or too long; on the angle bench, errors of one order.
std::vector<std::string> AlikeByShape(const std::string& effect) {
  const std::vector<std::vector<std::string>> sets = {{"psd_distance", "stray_light", "background"},
                                                      {"eccentricity", "signal_offset", "tilt"},
                                                      {"bar_gain", "bar_nonlinearity"},
                                                      {"focal_length", "spot_size"}, {"qpd_gain", "leakage"},
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

double TwinOptions::RhoOf(int k) const {
  const int magnitude = k / seeds;
  return rho_from * std::pow(rho_to / rho_from, (magnitude + 0.5) / magnitudes);
}

std::vector<Plan> SinglePlans(const std::string& bench, const TwinOptions& options) {
  std::vector<Plan> plans;
  std::uint64_t seed = options.first_seed;
  for (const Placement& at : Placements(bench)) {
    for (int k = 0; k < MagnitudesOf(at, bench, options) * options.seeds; ++k)
      plans.push_back(SinglePlan("twin " + bench, at, options.RhoOf(k), ++seed));
  }
  return plans;
}

std::vector<Plan> LeaveOneOutPlans(const std::string& bench, const TwinOptions& options) {
  constexpr double kRho = 20.0;
  std::vector<Plan> plans;
  std::uint64_t seed = 200000 + options.first_seed;
  for (const Placement& at : Placements(bench)) {
    if (!HasSize(at.effect, at.where, bench)) continue;
    for (int k = 0; k < options.seeds; ++k) {
      Plan plan = SinglePlan("leave-one-out", at, kRho, ++seed);
      plan.make = [make = std::move(plan.make)] { return WithoutItsCause(make()); };
      plans.push_back(std::move(plan));
    }
  }
  return plans;
}

std::vector<Plan> PairPlans(int count, const TwinOptions& options) {
  std::vector<Plan> plans;
  const std::vector<Wanted> all = SizedEffects(kRotaryBench);
  Stream stream(options.first_seed, "hidden.pairs");
  while (std::ssize(plans) < count) {
    const std::vector<Wanted> pair = DrawPair(all, options.rho_to, stream);
    const std::uint64_t seed = 100000 + options.first_seed + plans.size();
    plans.push_back(
        {"pairs", std::to_string(seed), [=] { return MakeTwinCase(Design::kRotary, seed, pair, ScaleOf(Design::kRotary)); }});
  }
  return plans;
}

std::vector<Plan> CreepPlans(const std::string& bench, const std::vector<Clamped>& ways,
                             const TwinOptions& options) {
  std::vector<Plan> plans;
  std::uint64_t seed = 500000 + options.first_seed;
  for (const Placement& at : Placements(bench)) {
    if (at.effect != "mount_creep") continue;
    for (const Clamped& way : ways) {
      ++seed;
      const Wanted wanted{at.effect, at.where, options.RhoOf(0), {{"time_constant", way.time_constant_s}}};
      const auto clamp = [way](Scenario& actual) { Remount_s(actual) = way.before_s; };
      plans.push_back({"creep " + bench,
                       fmt::format("{}:{:.0f}s:{:.0f}s", CaseName(at, seed), way.before_s, way.time_constant_s),
                       [=] { return MakeTwinCase(at.design, seed, {wanted}, ScaleOf(at.design), clamp); }});
    }
  }
  return plans;
}

Scenario HiddenBench(Design design, std::uint64_t seed, const std::vector<Wanted>& wanted,
                     const SignatureScale& scale, const Otherwise& otherwise) {
  Scenario actual = Drawn(design, seed);
  if (otherwise) otherwise(actual);
  actual.effects = DrawEffects(wanted, actual, scale);
  return actual;
}

Case MakeTwinCase(Design design, std::uint64_t seed, const std::vector<Wanted>& wanted, const SignatureScale& scale,
                  const Otherwise& otherwise) {
  const Scenario actual = HiddenBench(design, seed, wanted, scale, otherwise);
  Case made;
  made.scenario = Believed(design);
  made.readings = TakeReadings(actual);
  made.hidden = TruthOf(actual.effects);
  made.hidden.alike = AlikeOf(actual.effects.front(), Drawn(design, seed), scale);
  if (wanted.size() == 1 && HasSize(wanted.front().effect, wanted.front().where, actual.bench))
    made.hidden.rho = wanted.front().rho;
  return made;
}

std::vector<Placement> Placements(const std::string& bench) {
  std::vector<Placement> placements;
  for (const EffectEntry& entry : EffectCatalogue(bench)) {
    for (const std::string& place : PlacesOf(entry)) {
      for (const Design design : DesignsFor(entry.name, bench)) placements.push_back({entry.name, place, design});
    }
  }
  return placements;
}

std::vector<Design> PlainDesigns(const std::string& bench) { return DesignsFor("", bench); }

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
