#pragma once

#include <Eigen/Core>
#include <vector>

#include "twin/core/reading.h"

namespace twinbench::model {

/// Under which circumstances each reading was taken; one entry a reading, NaN where it was not recorded or where
/// the bench has nothing of the kind.
struct Course {
  std::vector<int> reading;  // running number in the file
  std::vector<int> setup, pass, direction, position;
  std::vector<Phase> phase;
  Eigen::VectorXd time_s, dwell_s, temperature_degC;
  Eigen::VectorXd target_rad, reference_rad;  // unwrapped; an angle bench has only the reference
  Eigen::VectorXd velocity_rad_s;             // of a bench that is read in motion

  int Readings() const { return static_cast<int>(reading.size()); }
};

Course CourseOf(const std::vector<Reading>& readings);

}  // namespace twinbench::model
