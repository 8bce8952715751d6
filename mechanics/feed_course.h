#pragma once

#include <vector>

#include "mechanics/feed_drive.h"

namespace twinbench::mechanics {

/// What is commanded until a time.
struct FeedLeg {
  CircleMotion motion;
  double until_s = 0.0;
};

/// Where one axis was while it followed one command after the other: how far off the command, at times between
/// which cubics are good to 0.01 nm in steady motion; 2 ms apart where bristles bend or something rings.
class FeedCourse {
 public:
  /// Runs the drive from its time 0, where it must have begun with the first leg's motion.
  FeedCourse(FeedDrive& drive, CircleAxis axis, const std::vector<FeedLeg>& legs);

  /// Slide minus command. @throws std::invalid_argument before the beginning or behind the last leg's end.
  double Off_m(double time_s) const;
  std::size_t Knots() const { return knots_.size(); }

 private:
  struct Knot {
    double time_s, off_m, off_m_s;
  };
  void Keep(const Knot& now, bool leapt);

  std::vector<Knot> knots_;
  Knot last_ = {};  // it may have been left out
  bool left_out_ = false;
};

}  // namespace twinbench::mechanics
