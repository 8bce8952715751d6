#pragma once

#include <array>
#include <string>
#include <vector>

#include "tests/foreign/machine.h"
#include "tests/hidden/judge.h"

/// What the program makes of a foreign machine, and how true it is.
namespace twinbench::foreign {

struct Answer {
  std::string set, name;
  Truth truth;
  hidden::Outcome outcome;  // answer in words, stated probabilities with what is so, seconds
  bool alarm = false;
  std::string wrong;        // the surest name that neither is there nor near; empty: none
  double wrong_at = 0.0;    // its probability
  bool named_near = false;  // a name that is there or near is in the answer
  int missing = 0;          // causes that are neither named, nor among what could be meant, nor said to be unknown

  bool was_extended = false;  // a scenario was written
  std::string second;         // what the second diagnosis says of the same readings; empty: nothing
  double stated_gain = kNaN, file_gain = kNaN;  // on another run, without tables of the first one
  std::array<double, 2> stated_interval = {kNaN, kNaN};
};

/// @param diagnosis  Of the machine's first run.
Answer Judge(const Truth& truth, const diagnose::Diagnosis& diagnosis);

/// Diagnoses a run of the machine, writes the extended scenario, reads it, diagnoses the same readings with it, and
/// holds it against another run.
Answer Examine(const Plan& plan, const std::string& cache_folder);

/// Share of what the faults add to the readings of another run that the scenario explains; noise is not on them.
/// 0 for a scenario that cannot be applied to them.
double GainOn(const Machine& machine, const Scenario& extended);

/// Was this answer wrong at this probability or more?
inline bool IsWrongAt(const Answer& a, double probability) {
  return !a.wrong.empty() && a.wrong_at >= probability;
}

}  // namespace twinbench::foreign
