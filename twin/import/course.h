#pragma once

#include <string>
#include <vector>

#include "twin/import/map.h"

/// How an axis moved, from what its reference shows: turns, reversals, rests, ramps.
namespace twinbench::imports {

enum class Motion { kStop, kRest, kRamp, kSteady };
const char* MotionName(Motion motion);  // "stop", "rest", "ramp", "steady"

/// One entry a row.
struct Course {
  bool stops = false;             // every row is a reading at rest
  bool stop_and_go = false;       // recorded in time, from rest to rest: every rest is a reading
  std::vector<double> reference;  // without breaks [rad]
  std::vector<double> velocity;   // [rad/s]; NaN without a clock
  std::vector<int> direction;     // +1, -1; 0: at rest
  std::vector<int> pass;          // counts up at every reversal and every fly-back
  std::vector<Motion> motion;
  int wraps = 0, reversals = 0, rests = 0, fly_backs = 0;
  double turns = 0.0;       // from its lowest to its highest angle
  double rest_share = 0.0;  // of the rows
  double fastest = 0.0;     // usual top speed [rad/s]
  double noise = 0.0;       // of the reference, from row to row [rad]
};

/// Takes out the jumps of a reference that starts again at `wrap_rad`.
/// @return how many there were.
int Unwrap(double wrap_rad, std::vector<double>& angle);

/// @param time_s  Empty: rows without a clock are stops.
/// @param wrap_rad  The period at which `reference` starts again; 0: none.
Course CourseOf(std::vector<double> reference, const std::vector<double>& time_s, const CourseSettings& settings,
                double wrap_rad);

/// The period of the wraps that are in `reference`: the stated one, a turn if it jumps by nearly that, or 0.
double FindWrap(const std::vector<double>& reference, const CourseSettings& settings, bool linear);

}  // namespace twinbench::imports
