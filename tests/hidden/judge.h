#pragma once

#include <array>
#include <functional>

#include "twin/diagnose/diagnose.h"

/// Cases with something hidden in them, what a right answer to each is, how answers are marked, and the scenario
/// that a diagnosis writes, held against readings and against a second run of a machine, on another day.
namespace twinbench::hidden {

/// One cause as it was hidden. Parameters that are not known stay out.
struct Part {
  std::string effect, where;                 // where: empty if the truth does not say
  std::map<std::string, double> parameters;  // SI, by the catalogue's names
};

/// What is wrong with the readings of a case. Neither causes nor an unlisted one: nothing is.
struct Hidden {
  std::vector<Part> causes = {};        // of the catalogue; two of them: a pair
  std::vector<std::string> alike = {};  // effects that these readings cannot tell from the cause, itself included
  std::string unlisted = {};            // a cause that the catalogue lacks; empty: none
  std::vector<std::string> locks = {};  // of the unlisted one: its signature must have one of these words
  std::vector<std::string> channels = {};  // ... and the channels that it must name; empty: not asked
  std::string noise = {};                  // what is special about the noise: "t5", "AR(1) 0.3"
  bool invisible = false;                  // the free unknowns take it up entirely: finding nothing is right
  double rho = kNaN;                       // intended length of the signature after projection, in units of noise

  bool IsClean() const { return causes.empty() && unlisted.empty(); }
};

struct Case {
  Hidden hidden = {};
  Scenario scenario = {};  // what is believed of the bench
  std::vector<Reading> readings = {};
  diagnose::DiagnoseOptions options = {};
};

/// A case before it is made: thousands of them fit into memory.
struct Plan {
  std::string set, name;
  std::function<Case()> make;
};

template <class T>
std::vector<T> Every(std::size_t step, const std::vector<T>& all) {
  std::vector<T> some;
  for (std::size_t k = 0; k < all.size(); k += step) some.push_back(all[k]);
  return some;
}

/// "psd_gain psd_a_x", "backlash + tone all", "none", "unlisted etalon".
std::string InWords(const Hidden& hidden);

enum class Grade {
  kQuiet,             // nothing hidden or nothing to be seen of it, nothing found
  kFalseAlarm,        // nothing hidden, something found
  kMissed,            // something hidden, nothing found
  kRight,             // all that is hidden, and nothing else, by name and place
  kRightAndMore,      // the hidden cause and another one that is not there
  kTie,               // a tie that contains the truth, of at most three members
  kLargeTie,          // the same with more members
  kPartly,            // one of a pair
  kAnsweredUnknown,   // a listed cause, answered `unknown`
  kUnknown,           // an unlisted cause, answered `unknown` with its lock and channels
  kUnknownMisplaced,  // the same with another lock or other channels
  kWrong,             // another name
  kRefused            // no answer: the design or the file was refused
};

/// A parameter of a cause that was named rightly, against its truth.
struct ParameterCheck {
  std::string name;
  double value = kNaN, u = kNaN, truth = kNaN;
  double period = 0.0;  // of a phase: it is compared modulo this; 0: as it stands
  double Error() const;
  bool Covers() const;  // truth within 1.96 standard uncertainties
};

inline constexpr double kSure = 0.8;  // a name is stated as good as certain from here on

/// One diagnosis against what was hidden.
struct Outcome {
  std::string set = {}, name = {};
  Hidden hidden = {};
  Grade grade = Grade::kRefused;
  diagnose::Verdict verdict = diagnose::Verdict::kNone;
  std::string answer = {};  // causes with their probabilities and signature of the unknown, in words
  double gain = kNaN;       // share of the removable variance of held-out readings
  bool sure_wrong =
      false;  // stated as sure: a name that is not there and that these readings can tell from what is
  std::vector<ParameterCheck> parameters = {};

  bool RightOrTie() const { return grade == Grade::kRight || grade == Grade::kTie; }
};

/// Named with its name or a tie, unlisted and answered so, or nothing there and nothing said.
inline bool IsRight(const Outcome& o) {
  return o.RightOrTie() || o.grade == Grade::kUnknown || o.grade == Grade::kQuiet;
}

Outcome Judge(const Hidden& hidden, const diagnose::Diagnosis& diagnosis);

/// Of an empty text nothing.
std::vector<std::string> Split(const std::string& text, const std::string& separator);

/// Channels that a signature speaks of, also by the name of a pattern ("tilt": both y channels).
std::vector<std::string> ChannelsIn(const std::string& signature);

/// P(X <= count) of a binomial distribution.
double ProbabilityOfAtMost(int count, int of, double p);

/// `count` cases in `of`.
struct Share {
  int count = 0, of = 0;
  /// Clopper-Pearson, both between 0 and 1; of no cases: all between.
  std::array<double, 2> Interval95() const;
};

/// By way of the file's text, as a user has it.
/// @throws InputError if it cannot be read.
Scenario WrittenFile(const Scenario& believed, const diagnose::DiagnosisRun& found);

/// What a diagnosis has to say of the readings; empty if nothing. A refusal is something.
std::string Says(const std::vector<Reading>& readings, const Scenario& scenario,
                 const diagnose::DiagnoseOptions& options);

/// The same bench asked for another schedule: it begins elsewhere, goes the other way round first, dwells
/// otherwise.
Scenario WithOtherSchedule(Scenario scenario);

/// The same bench with another schedule, other noise, and a room that is warmer and drifts the other way.
Scenario OnAnotherDay(const Scenario& actual);

}  // namespace twinbench::hidden
