#pragma once

#include <functional>
#include <string>
#include <vector>

#include "twin/plan/next_run.h"

namespace twinbench::plan {

/// A comparison of two rotary tables at the n stops of a full circle, once for each shift of one against the other; or of
/// a ring with what it is read against by several heads, on n places where a head may stand.
struct ShiftDesign {
  int positions = 0;        // 0: this scenario shifts nothing
  std::vector<int> shifts;  // in stops, or places of heads
  /// Keys of the scenario for other shifts: "procedure.shifts=[0, 7]".
  std::function<std::vector<std::string>(const std::vector<int>&)> sets = {};
  std::vector<NextRun> other_ways = {};  // of making the same set-ups
  std::string words = "mountings at the shifts";  // what stands before a list of them
};

/// Variances of the harmonics 1 to n / 2 of one table's error, in units of what the mean of all set-ups would leave of
/// noise alone (separate::shifts::HarmonicTransfer). 1 is the best that any set can do, infinite is a harmonic that no
/// reading tells of one table.
std::vector<double> VarianceFactors(int positions, const std::vector<int>& shifts);

/// Of a set of shifts.
struct ShiftSet {
  std::vector<int> shifts;
  double mean_factor =
      0.0;  // over the harmonics that some set of so many shifts tells apart; infinite if one is lost
  double worst_factor = 0.0;
  double least_possible = 1.0;  // mean_factor that no set of so many shifts is below (LeastPossible)
  std::vector<int> lost;    // harmonics
  bool exhaustive = false;  // every set was looked at; else the best that exchanging one shift at a time found
};

/// Mean variance that no set of m shifts is below: the squared sums of all orders add up to n m - m^2 whatever the
/// shifts (Parseval), and 1 / (1 - x) is convex (Jensen). Sets that reach it are cyclic difference sets.
double LeastPossible(int positions, int count);

ShiftSet Judged(int positions, const std::vector<int>& shifts);

/// The set of `count` shifts, 0 among them, with the least mean variance (A-optimal). Every set is looked at up to
/// some millions, which are counted without mirror images; else one shift after the other is exchanged for the best
/// there is, from up to 24 starts (one alone above some 2000 positions), until none is better. How far it is from the best that there could be is told by
/// mean_factor itself: no set is below 1.
/// @param count  From 2 to positions.
ShiftSet BestShifts(int positions, int count);

/// `shifts` and the one more that loses the fewest harmonics, and of these leaves the least mean variance.
ShiftSet WithOneMore(int positions, const std::vector<int>& shifts);

}  // namespace twinbench::plan
