#pragma once

#include <Eigen/Core>

#include "twin/model/course.h"

namespace twinbench::model {

/// The longest time between two readings of one motion, in usual steps: some are left out, none is a pause.
inline constexpr double kLongestStep = 3.5;

/// Rate of change of what has one value a reading, by the times of the course [1/s]: the slope of the parabola through
/// a reading and its neighbours of the same motion, the nearest two at its ends, zero where there is no neighbour.
///
/// A motion goes on from reading to reading of a mounting as long as none is missing, also where it turns back: a pass
/// ends there, and what goes with the acceleration is largest.
Eigen::VectorXd RateOfChange(const Course& course, const Eigen::VectorXd& values);

/// Values with noise of their own, as what an encoder shows in motion has, and their rate of change.
struct SteadyCourse {
  Eigen::VectorXd values, rate;
  bool is_smoothed = false;
};

/// The parabola through as many neighbours (32 on either side at most) as make the noise small in its slope, a hundredth of
/// the slope's rms: differences of neighbours would hold the noise of the very reading that they are compared with. Where the
/// noise is small, and about corners of the motion, the values as they are.
SteadyCourse SteadyCourseOf(const Course& course, const Eigen::VectorXd& values);

}  // namespace twinbench::model
