#pragma once

#include <optional>

#include "tests/foreign/machine.h"
#include "tests/hidden/judge.h"

/// What the program makes of a foreign machine, and how true it is.
namespace twinbench::foreign {

struct Answer {
  std::string set, name;
  Truth truth;
  std::string words;  // the answer
  bool alarm = false, is_tie = false;
  std::string wrong;        // the surest name that neither is there nor near; empty: none
  double wrong_at = 0.0;    // its probability
  bool named_near = false;  // a name that is there or near is in the answer
  int missing = 0;          // causes that are neither named, nor among what could be meant, nor said to be unknown

  // Where a scenario was written: what diagnoses with it say of the same readings and of those of another run;
  // empty words: nothing. The second is not asked of faults that another run does not repeat.
  std::optional<std::string> second, second_run;
  double stated_gain = kNaN, file_gain = kNaN;  // on another run, without tables of the first one
};

/// @param diagnosis  Of the machine's first run.
Answer Judge(const Truth& truth, const diagnose::Diagnosis& diagnosis);

/// Diagnoses a run of the machine, writes the extended scenario, reads it, diagnoses the same readings with it, and
/// holds it against another run, which, noise and all, is diagnosed with it too.
Answer Examine(const Plan& plan);

/// Share of what the faults add to the readings of another run that the scenario explains; noise is not on them.
/// 0 for a scenario that cannot be applied to them.
double GainOn(const Machine& machine, const Scenario& extended);

/// A name that is not there at any probability above one half, or a tie without one that is near.
bool IsNamedWrongly(const Answer& a);

/// A name that is neither there nor near, stated as sure.
inline bool IsSurelyWrong(const Answer& a) {
  return !a.wrong.empty() && a.wrong_at >= hidden::kSure;
}

/// A machine in order is answered with nothing; everything else is found or said to be there, and nothing named
/// wrongly.
bool IsRight(const Answer& a);

/// The stated gain is that of the file on another run; nothing if either is not asked.
std::optional<bool> IsGainRight(const Answer& a);

}  // namespace twinbench::foreign
