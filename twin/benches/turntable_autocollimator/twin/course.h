#pragma once

#include <string>
#include <vector>

#include "mechanics/plant.h"
#include "twin/benches/turntable_autocollimator/twin/effect.h"
#include "twin/core/reading.h"

namespace twinbench::sim {

/// A set-up of the turntable bench as a record and the procedure's settings tell it.
struct TurntableMounting {
  double tilt_rad = 0.0, azimuth_rad = 0.0, eccentricity_m = 0.0, shift_rad = 0.0;
};

/// How the bench stood at one reading of a record.
struct TurntableStop {
  TurntableMoment moment;
  mechanics::StackState axes;
  double above_K = 0.0;
  std::size_t mounting = 0;  // running number
  int tooth = 0;
  double beside_tooth_rad = 0.0;  // of the multi-tooth table, where a record has it between teeth
  bool known = true;              // the record says where the tables stood
};

/// The course of a record: the turntable is sent the recorded way (every pass from behind its first stop, a sweep
/// from twice its reach, as the procedure does), mounted where the set-up changes, and as warm as the record says.
struct TurntableCourse {
  std::vector<TurntableStop> stops;  // one a reading
  std::vector<TurntableMounting> mountings;
  std::vector<std::string> unfixed;  // what the record does not say and what was taken instead
};

/// @param actual  Effects included. Of fidelity "bullet" the linear model is asked: once the servo is quiet they
/// are
///                the same to a hundredth of an arcsecond.
TurntableCourse FollowCourse(const std::vector<Reading>& record, const Scenario& actual);

}  // namespace twinbench::sim
