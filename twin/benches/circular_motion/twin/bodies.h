#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include "mechanics/feed_course.h"
#include "twin/benches/circular_motion/settings.h"
#include "twin/benches/circular_motion/twin/machine.h"

namespace twinbench::sim {

/// Where on its pass a reading was taken.
struct CirclePlace {
  int setup = 0, pass = 0;
  CircleInstant at;

  friend bool operator==(const CirclePlace& a, const CirclePlace& b) {
    return a.setup == b.setup && a.pass == b.pass && a.at.SameCourse(b.at);
  }
};

/// The two axes as bodies on the course of a run, pass by pass. A sweep has been in motion for half a circle and
/// more before its first reading. Stops are gone to along the circle in as long as it takes at the rapid feed, or
/// in two of the control's ramps if that is longer, behind half a circle at that feed, and read at the end of the
/// dwell.
class CircleBodies {
 public:
  /// @throws InputError if no drive can be made of [drives].
  CircleBodies(const CircularSettings& settings, const std::vector<CirclePlace>& places);

  /// Place of axis k without the machine's errors of place, so long before reading i.
  /// @throws InputError if that is more than 3 s behind the last reading of its pass or before its lead-in.
  double Position_m(std::size_t reading, std::size_t axis, double before_s) const;

  /// Whether these are the bodies of a scenario with these settings on this course.
  bool AreOf(const CircularSettings& settings, const std::vector<CirclePlace>& places) const;

 private:
  struct Pass {
    std::vector<mechanics::FeedLeg> legs;
    std::vector<mechanics::FeedCourse> axes;
  };
  struct Taken {
    std::size_t pass;
    double time_s;                   // on the pass
    double radius_m, commanded_rad;  // as the reading says
  };

  void AddSweep(const std::vector<CirclePlace>& places, std::size_t first, std::size_t end);
  void AddStops(const std::vector<CirclePlace>& places, std::size_t first, std::size_t end);
  void Run(Pass pass);

  CircularSettings settings_;
  std::vector<CirclePlace> places_;
  std::vector<Pass> passes_;
  std::vector<Taken> taken_;  // one a reading
};

/// Bodies that have been run once are not run again for the same drives on the same course: a diagnosis asks many
/// times. Threads may share it.
class BodiesOnce {
 public:
  /// Nothing where the axes have no bodies.
  std::shared_ptr<const CircleBodies> Of(const CircularSettings& settings, const std::vector<CirclePlace>& places);

 private:
  std::mutex mutex_;
  std::shared_ptr<const CircleBodies> last_;
};

/// What the drives do in the format's own words.
struct DrivesInClosedForm {
  AxisPair lag_s, backlash_m;
};
DrivesInClosedForm InClosedForm(const FeedDrivesSettings& drives);

}  // namespace twinbench::sim
