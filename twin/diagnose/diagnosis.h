#pragma once

#include <array>
#include <string>
#include <vector>

#include "twin/core/reading.h"

/// What a diagnosis says. The fields are those of diagnosis.json (formats.md); values are SI, the file has units.
namespace twinbench::diagnose {

enum class Verdict { kNone, kNamed, kTie, kUnknown };
const char* VerdictName(Verdict verdict);  // "none", "named", "tie", "unknown"

/// One parameter of a cause as fitted.
struct ParameterEstimate {
  std::string name;     // as in the effect catalogue: "gain_error"
  std::string unit;     // "1", "mrad", ...
  double to_SI = 1.0;   // factor from `unit` to SI
  double value = kNaN;  // SI
  double u = kNaN;      // standard uncertainty, SI; NaN where a grid only brackets it
  double lower = kNaN;  // physical bounds, SI
  double upper = kNaN;
};

/// A cause that these readings cannot tell from another.
struct Rival {
  std::string effect, where;
  double overlap = kNaN;  // share of the signature that the rival can imitate, 0 to 1
};

struct Cause {
  std::string effect = {}, where = {};
  double probability = kNaN;   // capped (see engine/family.h)
  double log_evidence = kNaN;  // log Bayes factor against its absence
  double rho = kNaN;           // length of its fitted signature after projection, in units of noise
  std::vector<ParameterEstimate> parameters = {};
  std::vector<Rival> indistinguishable_from = {};
  std::string next_measurement = {};  // what would tell it from its rivals; empty if nothing is needed
};

/// Structure that no cause of the catalogue explains.
struct UnknownPart {
  double probability = 0.0;
  std::string signature;  // grammar of docs/diagnosis.md: shape, lock, channels, amplitude; empty if there is none
};

/// How much better the extended model predicts passes that it was not fitted to.
struct Gain {
  double before_m = kNaN, after_m = kNaN;  // rms of prediction errors on held-out passes; rad for an angle bench
  double noise_floor_m = kNaN;             // what a perfect model would leave
  double fraction_removed = kNaN;          // of the removable variance
  std::array<double, 2> interval95 = {kNaN, kNaN};  // of fraction_removed, bootstrap over blocks
  double another_run = kNaN;                        // what is expected of a run taken at another time (held_out.h)
  bool has_tables_of_run = false;                   // which tell nothing of another, and are left out of that
  bool positive = false;                            // the gain is above zero at 95 %
  int folds = 0;
};

/// A cause that this run would not show, and what that may do to the results.
struct Invisible {
  std::string effect, where;
  std::string could_bias;  // "target ez up to 0.4 arcsec rms"
};

/// The smallest size of a cause that would have been seen (Baarda's delta_0 = 4.13).
struct Detectable {
  std::string effect, where;
  ParameterEstimate smallest;  // `value` only
};

/// One order of an angle device's error, all orders fitted together.
struct Harmonic {
  int order = 0;
  double amplitude_rad = kNaN, u_amplitude_rad = kNaN;
  double phase_rad = kNaN, u_phase_rad = kNaN;  // of amplitude * cos(order * angle + phase)
  std::string meaning;                          // what an order of this kind can and cannot mean
};

struct Diagnosis {
  Verdict verdict = Verdict::kNone;
  double alarm_p = kNaN;
  std::vector<Cause> causes =
      {};  // most probable first; a tie lists all its members; simultaneous causes follow each other
  UnknownPart unknown = {};
  std::vector<std::string> noise = {};  // repairs of the noise model, in words: "tails like Student's t with 5 dof"
  Gain gain = {};
  std::vector<Invisible> invisible = {};
  std::vector<Detectable> detectable = {};
  std::vector<Harmonic> harmonics = {};  // angle devices only, ascending order
  int readings = 0;                      // used
  int left_out = 0;                      // NaN, saturated, no light, ...
  std::vector<std::string> notes = {};   // missing columns and what cannot be named without them, and the like
};

/// Some of the readings' structure has no name, whether it dominates (Verdict::kUnknown) or stands beside causes.
bool HasUnmodelled(const Diagnosis& diagnosis);

}  // namespace twinbench::diagnose
