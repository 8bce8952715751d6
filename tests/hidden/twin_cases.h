#pragma once

#include "tests/hidden/bench_runs.h"
#include "twin/core/effect_catalogue.h"

/// Cases with effects of the catalogue, with nothing wrong, and of the independent generators.
namespace twinbench::hidden {

struct TwinOptions {
  int magnitudes = 3;  // sizes an effect and place, spread over rho_from to rho_to in equal ratios
  int seeds = 2;       // of each size
  std::uint64_t first_seed = 1;
  double rho_from = 5.0, rho_to = 30.0;

  /// The size of the k-th of magnitudes x seeds cases.
  double RhoOf(int k) const;
};

/// One effect at a time: every name, every place; on the angle bench at stops and in motion.
std::vector<Plan> SinglePlans(const std::string& bench, const TwinOptions& options);

/// When the clamp closed, before the first reading of each set-up, and the creep's time constant.
struct Clamped {
  double before_s, time_constant_s;
};
/// mount_creep at every place, in each of these ways: the clamp closed sooner or later than the scenario believes,
/// which says only how long a set-up takes as a rule.
/// @param bench  That has it: rotary_4dof, turntable_autocollimator.
std::vector<Plan> CreepPlans(const std::string& bench, const std::vector<Clamped>& ways,
                             const TwinOptions& options);

/// Two different effects of the rotary bench at once, rho of each between 10 and `rho_to`.
std::vector<Plan> PairPlans(int count, const TwinOptions& options);

/// One effect at rho 20 that the catalogue is made to lack: `seeds` cases an effect and place.
std::vector<Plan> LeaveOneOutPlans(const std::string& bench, const TwinOptions& options);

/// An effect that a case is to hide.
struct Wanted {
  std::string effect, where;
  double rho = kNaN;  // wanted length of its signature, in units of noise; not used if it has no size
  std::map<std::string, double> parameters = {};  // SI, that are not drawn
};

/// What else of the bench is not as believed, without being wrong.
using Otherwise = std::function<void(Scenario& actual)>;

/// The bench of one case with the wanted effects on.
Scenario HiddenBench(Design design, std::uint64_t seed, const std::vector<Wanted>& wanted,
                     const SignatureScale& scale, const Otherwise& otherwise = {});

/// A run of the twin with the wanted effects on, to be diagnosed with the scenario that lacks them.
///
/// @param wanted  One or more; alike are the effects that cannot be told from the first.
/// @param scale   Of the same design.
Case MakeTwinCase(Design design, std::uint64_t seed, const std::vector<Wanted>& wanted, const SignatureScale& scale,
                  const Otherwise& otherwise = {});

inline constexpr int kNoises = 7;

/// `count` runs, the noises in turn. On the angle bench, where the noise is not stated but estimated, that of a
/// wrong size is Gaussian noise of a device whose noise is stated.
std::vector<Plan> CleanPlans(const std::string& bench, int count, std::uint64_t first_seed);

/// "challenge" of the rotary bench, else with the first word of the bench's name: "challenge_circular".
std::string ChallengeSetOf(const std::string& bench);

/// @param bench  Decides the scenario that is believed.
/// @param excluded  Effects taken out of the catalogue.
/// @return one plan a folder, in the order of their names.
/// @throws InputError if there is no such folder or no case in it.
std::vector<Plan> ChallengePlans(const std::string& folder, const std::string& bench,
                                 const std::vector<std::string>& excluded = {});

}  // namespace twinbench::hidden
