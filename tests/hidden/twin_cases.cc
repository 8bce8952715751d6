#include "tests/hidden/twin_cases.h"

#include <cmath>
#include <map>
#include <memory>

#include "tests/hidden/effect_size.h"
#include "tests/hidden/placements.h"
#include "tests/hidden/twin_case.h"

namespace twinbench::hidden {
namespace {

using SharedScale = std::shared_ptr<const SignatureScale>;

/// Scales of the designs that were asked for, each made once.
class Scales {
 public:
  explicit Scales(std::string cache_folder) : cache_folder_(std::move(cache_folder)) {}
  SharedScale Of(Design design) {
    SharedScale& scale = scales_[design];
    if (!scale) scale = std::make_shared<const SignatureScale>(design, cache_folder_);
    return scale;
  }

 private:
  std::string cache_folder_;
  std::map<Design, SharedScale> scales_;
};

/// How many sizes an effect is hidden with: a swap has but one.
int MagnitudesOf(const Placement& at, const std::string& bench, const TwinOptions& options) {
  const bool comes_in_sizes =
      HasSize(at.effect, at.where, bench) || at.effect == "outliers" || at.effect == "multitooth_seating";
  return comes_in_sizes ? options.magnitudes : 1;
}

Plan SinglePlan(const std::string& set, const Placement& at, double rho, std::uint64_t seed,
                const SharedScale& scale) {
  const Wanted wanted{at.effect, at.where, rho};
  return {set, CaseName(at, seed),
          [wanted, seed, scale, design = at.design] { return MakeTwinCase(design, seed, {wanted}, *scale); }};
}

Case WithoutItsCause(Case made) {
  constexpr int kNullRuns = 200;  // at rho 20 the alarm is no question
  made.options.excluded = {made.hidden.causes.front().effect};
  made.options.null_runs = kNullRuns;
  return made;
}

}  // namespace

double TwinOptions::RhoOf(int k) const {
  const int magnitude = k / seeds;
  return rho_from * std::pow(rho_to / rho_from, (magnitude + 0.5) / magnitudes);
}

std::vector<Plan> SinglePlans(const std::string& bench, const TwinOptions& options) {
  std::vector<Plan> plans;
  Scales scales(options.cache_folder);
  std::uint64_t seed = options.first_seed;
  for (const Placement& at : Placements(bench)) {
    for (int k = 0; k < MagnitudesOf(at, bench, options) * options.seeds; ++k)
      plans.push_back(SinglePlan("twin " + bench, at, options.RhoOf(k), ++seed, scales.Of(at.design)));
  }
  return plans;
}

std::vector<Plan> LeaveOneOutPlans(const std::string& bench, const TwinOptions& options) {
  constexpr double kRho = 20.0;
  std::vector<Plan> plans;
  Scales scales(options.cache_folder);
  std::uint64_t seed = 200000 + options.first_seed;
  for (const Placement& at : Placements(bench)) {
    if (!HasSize(at.effect, at.where, bench)) continue;
    for (int k = 0; k < options.seeds; ++k) {
      Plan plan = SinglePlan("leave-one-out", at, kRho, ++seed, scales.Of(at.design));
      plan.make = [make = std::move(plan.make)] { return WithoutItsCause(make()); };
      plans.push_back(std::move(plan));
    }
  }
  return plans;
}

}  // namespace twinbench::hidden
