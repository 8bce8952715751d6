#pragma once

#include <optional>

#include "tests/foreign/angle_fault.h"
#include "tests/foreign/stand_fault.h"
#include "tests/hidden/judge.h"

/// Angle devices and rotary benches with faults, and in order; the sets of them; and what the program makes of one,
/// and how true that is.
namespace twinbench::foreign {

/// A fault with the length of what it shows on all channels, in units of noise, offsets and constants of the set-ups
/// apart. Free unknowns of the rotary bench take a further part of it, which depends on the fault.
template <class Kind>
struct Wanted {
  Kind kind;
  double rho;
};

Machine MakeAngleMachine(std::uint64_t seed, bool in_motion, const std::vector<Wanted<AngleKind>>& wanted);

/// Nothing wrong.
/// @param stops_per_turn  0: as drawn.
Machine MakeAngleInOrder(std::uint64_t seed, bool in_motion, const NoiseShape& noise, int stops_per_turn);

Machine MakeStand(std::uint64_t seed, const std::vector<Wanted<StandKind>>& wanted);

/// Nothing wrong.
Machine MakeStandInOrder(std::uint64_t seed, const NoiseShape& noise, int positions);

/// Every kind that the catalogue lacks, `each` times: angle devices at stops and in motion in turn, rotary benches.
std::vector<Plan> KindPlans(int each, std::uint64_t first_seed);

/// Two or three causes of the catalogue, or one or two with a weaker one that it lacks; of seven, two are rotary
/// benches.
std::vector<Plan> SeveralPlans(int count, std::uint64_t first_seed);

/// Nothing wrong: every stress in turn, and as many with plain noise and 8 to 360 positions. Of four, one is a
/// rotary bench.
std::vector<Plan> CleanPlans(int count, std::uint64_t first_seed);

/// Causes of the catalogue by a bench's twin, spread over its effects and places. Their other run is one of the
/// same bench on another day: these measure what is written of a cause, not how well it is found.
std::vector<Plan> TwinPlans(const std::string& bench, int count, std::uint64_t first_seed);

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
