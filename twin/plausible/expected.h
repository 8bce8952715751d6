#pragma once

#include <functional>
#include <string>
#include <vector>

#include "twin/core/reading.h"

namespace twinbench::plausible {

inline constexpr double kTimes = 20.0;  // smaller or larger than claimed: no figure of a data sheet is so far off
inline constexpr double kMuch = 20.0;   // of the noise: what differs by more is no noise

/// What a scenario claims of a column that is shown, before anything is known of what is measured.
struct Expected {
  std::string column;
  double noise = 0.0;  // of one reading, white, standard deviation [SI]; 0: not stated, or less than a step of the instrument
  double step = 0.0;   // least step of the reading [SI]; 0: not known
  double nulled = 0.0;  // to which it is brought back before every reading [SI]; 0: it is not
  double nulled_noise = 0.0;  // of what is left then
  /// What was made on purpose in it beside what is measured, but for a constant of each set-up: a tilt [SI]; NaN: not known.
  std::function<double(const Reading&)> course = {};
  std::string not_in = {};  // the column that shows nothing of that course
  /// What it shows by the angles and places of the reading, but for a constant of each set-up [SI]; NaN: not known.
  std::function<double(const Reading&)> nominal = {};
  /// What it shows by where the axes stand, near a place and but for a constant [SI]: none: no step of an axis proves it.
  std::function<double(const Reading&)> by_axes = {};
  bool is_angle = false;  // nominal: whole turns apart
  bool may_lag = false;   // nominal: a servo that comes later is no wrong order of readings
  bool is_loose =
      false;  // nominal: changed wires that a diagnosis names, or a mounting that nobody knows so well, are no reason to refuse
};

}  // namespace twinbench::plausible
