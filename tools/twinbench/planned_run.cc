#include "tools/twinbench/planned_run.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <memory>
#include <nlohmann/json.hpp>

#include "tools/twinbench/passing_run.h"
#include "tools/twinbench/progress.h"
#include "twin/benches/evaluated.h"
#include "twin/benches/registry.h"
#include "twin/core/errors.h"
#include "twin/core/estimator.h"
#include "twin/diagnose/isolability.h"
#include "twin/report/evaluation.h"

namespace twinbench::tools {
namespace {

/// Shares of a plan's time from which on these are left out: other runs come first, the mean over many runs last.
constexpr double kOfUnseen = 0.5, kOfRooms = 0.35, kOfAveraging = 0.6;

nlohmann::json ResultsOf(const Scenario& scenario, const std::vector<Reading>& readings) {
  return EvaluationOf(scenario, readings, Estimator::kRigorous).results;
}

plan::Outlook OutlookOf(const Scenario& scenario, const std::vector<Reading>& readings) {
  const double last_s = readings.empty() ? 0.0 : ToSeconds(readings.back().time);
  return plan::OutlookOf(ResultsOf(scenario, readings), static_cast<int>(readings.size()), last_s);
}

/// A twin without a cause, to be held against one that has it.
struct Plain {
  explicit Plain(const Scenario& s) : scenario(s), readings(ReadingsOfTwin(s)), results(ResultsOf(s, readings)) {}

  Scenario scenario;
  std::vector<Reading> readings;
  nlohmann::json results;
};

/// The cause is in the twin only: the evaluation believes the scenario.
std::vector<plan::Bias> BiasesBy(const EffectSettings& effect, const Plain& plain) {
  Scenario with = plain.scenario;
  with.effects.push_back(effect);
  return plan::BiasesOf(plain.results, ResultsOf(plain.scenario, ReadingsOfTwin(with)));
}

bool MoveNothing(const std::vector<plan::Bias>& biases) {
  return biases.empty() || biases.front().rms == 0.0;
}

plan::Unseen UnseenBy(const diagnose::ShownCause& cause, const Plain& quick, const Scenario& scenario) {
  plan::Unseen unseen{cause.effect, cause.where, diagnose::AsEffect(cause, scenario.bench), {}, ""};
  try {
    unseen.biases = BiasesBy(unseen.as, quick);
    if (MoveNothing(unseen.biases)) unseen.biases = BiasesBy(unseen.as, Plain(scenario));
  } catch (const InputError& refusal) {
    unseen.not_known = refusal.what();
  }
  return unseen;
}

}  // namespace

Scenario Quick(const Scenario& scenario) {
  Scenario quick = scenario;
  for (const char* set : {"mechanics.fidelity=kinematic", "optics.fidelity=closed"}) {
    try {
      quick = Altered(quick, {set});
    } catch (const InputError&) {  // the bench has no such choice
    }
  }
  return quick;
}

plan::Outlook OutlookAtOnce(const Scenario& scenario) {
  const Scenario quick = Quick(scenario);
  return OutlookOf(quick, ReadingsOfTwin(quick));
}

report::PlannedRun OwnRun(const Scenario& scenario, const plan::Outlook& own, Patience& patience) {
  constexpr double kSame = 0.02;                   // of u: it does not depend on the run's own noise
  constexpr std::size_t kMost = 16, kEnough = 4;  // u that scatters by 15 % is known to 4 % after the most, by 4 % to 2 % after enough
  std::vector<plan::Outlook> outlooks = {own};
  for (Scenario other = Quick(scenario); outlooks.size() < kMost;) {
    if (!patience.Allows(kOfAveraging, "the mean of uncertainties over more runs with other noise")) break;
    ++other.seed;
    outlooks.push_back(OutlookOf(other, ReadingsOfTwin(other)));
    if (plan::LargestDifference(outlooks[0], outlooks[1]) < kSame) break;
    if (outlooks.size() >= kEnough && plan::UncertaintyOfMean(outlooks) < kSame) break;
  }
  return {"as the scenario says", {}, own, plan::MeanOf(outlooks), outlooks.size()};
}

/// Stops at which the errors of both tables are free; 0: the bench shifts nothing.
int FreeStops(const Scenario& scenario) {
  const Bench& bench = BenchOf(scenario);
  if (!bench.shift_design) return 0;
  const plan::ShiftDesign design = bench.shift_design(scenario);
  return design.shifts.size() > 1 ? design.positions : 0;
}

/// @throws InputError if what all causes would show is too much to be weighed: with a table error that is free at every
///         stop, by a matrix of readings x stops.
void RequireWeighable(const Scenario& scenario, std::size_t readings) {
  constexpr double kMostReadings = 20000, kMostProducts = 1e10;  // half a minute
  const double count = static_cast<double>(readings);
  if (count > kMostReadings || count * std::pow(FreeStops(scenario), 2) > kMostProducts)
    throw InputError("plan", fmt::format("{} readings", readings), "fewer to say what causes would show");
}

diagnose::DiagnosisRun SeenBy(const Scenario& scenario, const std::vector<Reading>& readings) {
  RequireWeighable(scenario, readings.size());
  diagnose::DiagnoseOptions options;
  options.design_only = true;
  return BenchOf(scenario).diagnose(readings, scenario, options);
}

diagnose::DiagnosisRun SeenUnderChance(const Scenario& scenario, const std::vector<Reading>& readings, Patience& patience) {
  constexpr std::array kDrift_K_h = {0.0, 0.2, -0.2};  // more than stated: few rooms stand still
  Doing(fmt::format("what {} readings would show of causes", readings.size()));
  patience.Takes(kTellingOfCauses);
  diagnose::DiagnosisRun seen = SeenBy(scenario, readings);
  const auto [coolest, warmest] = std::ranges::minmax(readings, {}, &Reading::temperature_degC);
  if (!seen.isolability || !(warmest.temperature_degC > coolest.temperature_degC)) return seen;
  auto surely = std::make_shared<diagnose::Isolability>(*seen.isolability);
  Scenario other = Quick(scenario);
  for (const double drift_K_h : kDrift_K_h) {
    if (!patience.Allows(kOfRooms, "ties under another drift of the room's temperature")) continue;
    ++other.seed;
    Doing(fmt::format("the same under another drift of the room's temperature, {} of {}", other.seed - scenario.seed, kDrift_K_h.size()));
    other.environment.drift_K_h = scenario.environment.drift_K_h + drift_K_h;
    const diagnose::DiagnosisRun of_other = SeenBy(other, ReadingsOfTwin(other));
    diagnose::KeepSurelyTold(*of_other.isolability, *surely);
  }
  seen.isolability = surely;
  return seen;
}

report::PlannedEffects EffectsIn(const Scenario& scenario, const std::vector<Reading>& readings, Patience& patience) {
  report::PlannedEffects effects;
  try {
    effects.seen = SeenUnderChance(scenario, readings, patience);
    effects.unseen = UnseenEffects(scenario, effects.seen, patience);
  } catch (const InputError& refusal) {
    effects.refused = refusal.what();
  }
  return effects;
}

std::vector<plan::Unseen> UnseenEffects(const Scenario& scenario, const diagnose::DiagnosisRun& seen, Patience& patience) {
  const Plain quick(Quick(scenario));
  std::vector<plan::Unseen> all;
  for (const diagnose::ShownCause& cause : seen.isolability->causes) {
    Doing(fmt::format("what {} would move unseen, cause {} of {}", cause.effect, &cause - seen.isolability->causes.data() + 1, seen.isolability->causes.size()));
    if (cause.at_smallest.empty() || !patience.Allows(kOfUnseen, "what a cause would move unseen")) continue;
    all.push_back(UnseenBy(cause, quick, scenario));
  }
  return all;
}

}  // namespace twinbench::tools
