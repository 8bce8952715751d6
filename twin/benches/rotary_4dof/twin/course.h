#pragma once

#include <vector>

#include "twin/benches/rotary_4dof/twin/drives_along.h"
#include "twin/benches/rotary_4dof/twin/optical_path.h"
#include "twin/core/reading.h"

namespace twinbench::sim {

/// How the bench stood at one reading of a record.
struct RecordedStop {
  Moment moment;
  mechanics::StackState axes;
  int mounting = 0;  // running number of the mounting that it belongs to
  Time start{};      // of the block; the moment is its middle
  int n_samples = 0;
  // What the scenario's effects do at this reading.
  PoseState pose;
  LightState light;
  std::array<double, kChannels> added_V{};  // at the amplifiers' outputs
  bool swept = false;                       // the autocollimator saw the grating's normal at ...
  double seen_yaw_rad = 0.0;                // ... these angles, once its own gain is taken out
  double seen_tilt_rad = 0.0;
};

/// The course of a record: the tables are sent the recorded way (every pass from behind its first stop, as the
/// procedure does), mounted where the set-up or the phase changes, and warmed as the record says.
struct RotaryCourse {
  std::vector<RecordedStop> stops;   // one a reading
  std::vector<Stand> stands;         // one a mounting
  std::vector<std::string> unfixed;  // what the record does not say and what was taken instead
};

/// @param thermometer_noise_K  Standard deviation of a logged temperature.
/// @param path                 Its effects are led along the course.
RotaryCourse FollowCourse(const std::vector<Reading>& record, double thermometer_noise_K, OpticalPath& path,
                          DrivesOnce& drives);

}  // namespace twinbench::sim
