#pragma once

#include <Eigen/Core>
#include <vector>

#include "twin/core/reading.h"

/// An angle device compared with a reference on one shaft.
///
/// Everywhere in this folder: phi is the angle that the reference shows, th the angle of the device's own scale, x
/// what the device shows too much. D(th) is the error of the device, R that of the reference, both as "shows too
/// much", so that a device mounted at c_s (where the reference shows 0) has
///
///   x = c_s + D(th) - R(shaft),  shaft = phi - R(shaft),  th = shaft + c_s
///
/// A periodic function is written Re sum_k C_k exp(j k th), as in the folder hob.
namespace twinbench::separate::encoder {

/// The readings of one pass; one entry a reading.
struct ComparedPass {
  int pass = 0;
  int direction = 1;
  Eigen::VectorXd reference_rad;   // phi, without breaks at a turn
  Eigen::VectorXd error_rad;       // x
  Eigen::VectorXd velocity_rad_s;  // NaN if not known
  std::vector<int> lap;            // full turns since the pass began

  double Turns() const;  // that it covers
  double Middle_rad() const;
};

/// All passes of one set-up in one direction.
struct PassGroup {
  int setup = 0;
  int direction = 1;
  std::vector<ComparedPass> passes;

  int Readings() const;
};

struct SortedPasses {
  std::vector<PassGroup> groups;  // by set-up, direction +1 before -1
  int left_out = 0;               // readings at rest in a sweep (direction 0) or without a value
};

/// Takes measured - reference as CompareAngles does. A reference that wraps at a turn is followed: an angle that
/// goes back by more than half a turn against the direction of its pass has wrapped.
SortedPasses SortPasses(const std::vector<Reading>& readings);

}  // namespace twinbench::separate::encoder
