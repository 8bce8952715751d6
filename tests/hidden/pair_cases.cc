#include <memory>

#include "tests/hidden/effect_size.h"
#include "tests/hidden/placements.h"
#include "tests/hidden/twin_case.h"
#include "tests/hidden/twin_cases.h"
#include "twin/benches/names.h"

// Two causes at once.
namespace twinbench::hidden {
namespace {

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

}  // namespace

std::vector<Plan> PairPlans(int count, const TwinOptions& options) {
  std::vector<Plan> plans;
  const auto scale = std::make_shared<const SignatureScale>(Design::kRotary, options.cache_folder);
  const std::vector<Wanted> all = SizedEffects(kRotaryBench);
  Stream stream(options.first_seed, "hidden.pairs");
  while (std::ssize(plans) < count) {
    const std::vector<Wanted> pair = DrawPair(all, options.rho_to, stream);
    const std::uint64_t seed = 100000 + options.first_seed + plans.size();
    plans.push_back(
        {"pairs", std::to_string(seed), [=] { return MakeTwinCase(Design::kRotary, seed, pair, *scale); }});
  }
  return plans;
}

}  // namespace twinbench::hidden
