#include <fmt/format.h>

#include <memory>

#include "tests/hidden/placements.h"
#include "tests/hidden/twin_case.h"
#include "tests/hidden/twin_cases.h"
#include "twin/benches/names.h"
#include "twin/benches/rotary_4dof/settings.h"
#include "twin/benches/turntable_autocollimator/settings.h"

// Mounts that creep where the clamp closed sooner or later before the first reading than the scenario believes:
// when it closed, a scenario says only by how long a set-up takes as a rule.
namespace twinbench::hidden {
namespace {

double& Remount_s(Scenario& scenario) {
  return scenario.bench == kRotaryBench ? RotaryOf(scenario).procedure.remount_s
                                        : TurntableOf(scenario).turntable_procedure.remount_s;
}

}  // namespace

std::vector<Plan> CreepPlans(const std::string& bench, const std::vector<Clamped>& ways,
                             const TwinOptions& options) {
  std::vector<Plan> plans;
  std::uint64_t seed = 500000 + options.first_seed;
  for (const Placement& at : Placements(bench)) {
    if (at.effect != "mount_creep") continue;
    const auto scale = std::make_shared<const SignatureScale>(at.design, options.cache_folder);
    for (const Clamped& way : ways) {
      ++seed;
      const Wanted wanted{at.effect, at.where, options.RhoOf(0), {{"time_constant", way.time_constant_s}}};
      const auto clamp = [way](Scenario& actual) { Remount_s(actual) = way.before_s; };
      plans.push_back({"creep " + bench,
                       fmt::format("{}:{:.0f}s:{:.0f}s", CaseName(at, seed), way.before_s, way.time_constant_s),
                       [=] { return MakeTwinCase(at.design, seed, {wanted}, *scale, clamp); }});
    }
  }
  return plans;
}

}  // namespace twinbench::hidden
