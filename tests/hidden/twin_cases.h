#pragma once

#include <memory>
#include <mutex>

#include "tests/hidden/judge.h"
#include "twin/core/effect_catalogue.h"
#include "twin/core/stream.h"
#include "twin/diagnose/engine/projector.h"

/// Runs of the twin that differ in everything that may differ without being wrong; and cases with effects of the
/// catalogue, with nothing wrong, and of the independent generators.
namespace twinbench::hidden {

inline constexpr double kSensitivity_V_m = 2000.0;  // of the rotary bench's PSDs

/// The designs that cases are made with.
enum class Design {
  kRotary,  // rotary_4dof, re-seated
  kStops,
  kSweep,          // encoder_comparison
  kStopsAllKnown,  // the same with two mountings of the device, and its lines and teeth stated
  kSweepAllKnown,
  kTurntable,  // turntable_autocollimator, two tilts and eccentricities, with a sweep
  kHob,        // hob_transmission, two heads and two speeds
  kCircles,    // circular_motion, two radii and the grid
  kFreeform,   // freeform_five_axis, four mountings
  kStopsInWarmRoom  // encoder_comparison, whose room changes
};
struct DesignNames {
  std::string name, bench;
  std::vector<std::string> keys;  // in which it differs from the bench's scenario
};
const DesignNames& NamesOf(Design design);
inline const std::string& BenchOf(Design design) { return NamesOf(design).bench; }

/// What is believed of the bench.
Scenario Believed(Design design);

/// The bench of one case: tables, mountings, room and dwells drawn from `seed`, as believed otherwise.
Scenario Drawn(Design design, std::uint64_t seed);

/// Carries the scenario out on the twin of its bench.
std::vector<Reading> TakeReadings(const Scenario& actual);

/// Adds a signal to what the readings show: readings x channels, SI. Rotary bench: four PSD axes; turntable: x and
/// y; circles: radial and tangential; five axes: quadrants' x and y [V], camera [px]; the others: the angle.
void AddTo(const std::string& bench, const Eigen::MatrixXd& signal, std::vector<Reading>& readings);

/// Measures signatures in units of noise after projection, by what a clean run of the design leaves open, made when the
/// first one is asked for; where a design draws its schedule, by one of the same schedule.
class SignatureScale {
 public:
  explicit SignatureScale(Design design) : design_(design) {}

  /// Length of what two runs of the same schedule differ by.
  /// @param seed  Of the scenario that both were drawn by.
  double Rho(const std::vector<Reading>& with, const std::vector<Reading>& without, std::uint64_t seed) const;

 private:
  struct Clean {
    diagnose::LinearRun run;
    diagnose::NoiseModel noise;
    std::unique_ptr<diagnose::Projector> projector;
  };

  const Clean& CleanRun(std::uint64_t seed) const;
  Eigen::VectorXd Rows(std::vector<Reading> readings, const diagnose::LinearRun& clean) const;

  Design design_;
  mutable std::mutex one_at_a_time_;
  mutable std::map<std::uint64_t, Clean> clean_;  // by the seed of the schedule
};

/// Of the design, one a process.
const SignatureScale& ScaleOf(Design design);

double UniformIn(Stream& stream, double lower, double upper);
double LogUniformIn(Stream& stream, double lower, double upper);

/// An effect of the catalogue at one of its places, in a design that can show it.
struct Placement {
  std::string effect, where;
  Design design;
};

/// Every effect, place and design of a bench, in the order of the catalogue.
std::vector<Placement> Placements(const std::string& bench);

/// The designs of a bench without anything stated that few know.
std::vector<Design> PlainDesigns(const std::string& bench);

/// "rotary:psd_gain:psd_a_x:17": unique, and says what to expect before the case is made.
std::string CaseName(const Placement& placement, std::uint64_t seed);

/// Effects that the readings of a case cannot tell from this one, itself included.
///
/// @param drawn  The bench of the case.
std::vector<std::string> AlikeOf(const EffectSettings& effect, const Scenario& drawn, const SignatureScale& scale);

/// A place of `convention` that only relabels the positions: free errors of both tables are the same under other
/// labels.
bool OnlyRelabels(const std::string& where);

/// An effect with the sizes of the catalogue.
EffectSettings WithDefaults(const std::string& name, const std::string& where, const std::string& bench);

/// An effect of the catalogue with a shape and a sign drawn at random. Its size is the plausible one of the
/// catalogue; SizedTo brings it to what a case wants.
///
/// @param where  One of the effect's places; empty if it has none.
EffectSettings DrawEffect(const std::string& name, const std::string& where, const Scenario& scenario,
                          Stream& stream);

/// The parameter that an effect's signature grows with, in the catalogue the first that is not of a wave; empty if
/// it has no size.
std::string SizeParameter(const std::string& effect, const std::string& where, const std::string& bench);

/// Effects that leave a trace proportional to a size; the others (a swap, a frame) are there or not, or, as
/// outliers, come with a size of their own.
bool HasSize(const std::string& effect, const std::string& where, const std::string& bench);

/// Gives a wave that is stated by cosine and sine this phase; other effects stay.
void TurnWave(double phase_rad, const std::string& bench, EffectSettings& effect);

/// @param name  One of the effect's parameters.
const EffectParameter& CatalogueParameter(const std::string& bench, const std::string& effect,
                                          const std::string& name);

/// Readings of the bench without noise and with nothing but these effects.
std::vector<Reading> NoiseFree(Scenario scenario, const std::vector<EffectSettings>& effects);

/// The effect with its signature brought to the length `rho`, or to what the catalogue's bounds allow of it.
///
/// @param effect  With a size.
/// @param drawn   The bench of the case.
EffectSettings SizedTo(double rho, EffectSettings effect, const Scenario& drawn, const SignatureScale& scale);

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
/// @return one plan a folder, in the order of their names.
/// @throws InputError if there is no such folder or no case in it.
std::vector<Plan> ChallengePlans(const std::string& folder, const std::string& bench);

}  // namespace twinbench::hidden
