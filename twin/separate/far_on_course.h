#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "twin/core/reading.h"

/// Single readings that lie far from the course of their neighbours.
namespace twinbench::separate {

struct OnCourse {
  int reading;  // its number
  double angle_rad, value;
};

struct FarOnCourse {
  int reading = 0;
  double angle_rad = 0.0;
  double off = 0.0;    // from the curve through its neighbours
  double times = 0.0;  // the scatter of the others of its pass
};

/// Whether an axis that goes through a place once may do anything there, a step of the readings wide.
using MayBeThere = std::function<bool(double angle_rad, double step_rad)>;

/// Readings that lie far from the cubic through their neighbours, which agree without them, in one turn and in no other.
/// @param passes       Of one way round, each in order; those of fewer than twenty readings are passed over.
/// @param least        What no scatter is less than.
/// @param may_be_there  Asked of what no other turn goes through.
/// @return the farthest of each pass first; none of a pass where they are so many that the axis moves so.
std::vector<FarOnCourse> FarOnCourses(std::vector<std::vector<OnCourse>> passes, double least, const MayBeThere& may_be_there);

/// Takes single far readings of every set-up and direction out of the readings, turn by turn.
/// @param on_course  Where a reading lies; nothing of one that is not looked at.
/// @return what was taken out.
std::vector<FarOnCourse> TakeOutFar(std::vector<Reading>& readings, const std::function<std::optional<OnCourse>(const Reading&)>& on_course,
                                    double least, const MayBeThere& may_be_there);

}  // namespace twinbench::separate
