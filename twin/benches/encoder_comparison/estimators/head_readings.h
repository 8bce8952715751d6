#pragma once

#include <vector>

#include "twin/core/reading.h"

/// Several heads that read one ring at the same instants.
///
/// With the head j at b_j the ring stands at th_ij = shaft_i - b_j under it and shows, beyond the reference,
///
///   x_ij = c_s + e(th_ij) - r_i
///
/// e: the ring's error; r_i: what the reference shows too much at this instant, error and noise; c_s: zero of the
/// head in a set-up. Differences between heads hold no r_i.
namespace twinbench::separate::encoder {

struct HeadValue {
  int setup = 0;
  double head_rad = kNaN;  // b_j
  double ring_rad = kNaN;  // th_ij
  double x_rad = kNaN;     // without the mean of its set-up
};

/// What two or more heads showed at one instant.
struct HeadStop {
  double reference_rad = kNaN;
  int first_setup = 0;  // of the heads that belong together: one mounting of the ring
  std::vector<HeadValue> values;
};

struct HeadReadings {
  std::vector<HeadStop> stops;
  std::vector<double> heads_rad;  // ascending, each once
  int left_out = 0;               // readings without a value, or of a head that was alone

  int Values() const;
  /// The widest part of the turn without a stop [rad].
  double WidestGap_rad() const;
};

/// Readings of several heads: finite head_rad, equal times. Readings at rest between sweeps (direction 0) are left
/// out. What belongs to the ring's angle is referred to what the first head of each mounting shows in the mean.
HeadReadings SortHeads(const std::vector<Reading>& readings);

/// Whether the readings are of several heads.
bool HaveHeads(const std::vector<Reading>& readings);

}  // namespace twinbench::separate::encoder
