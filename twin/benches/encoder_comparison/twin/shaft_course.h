#pragma once

#include <vector>

#include "twin/benches/encoder_comparison/twin/effect.h"

namespace twinbench::sim {

/// Where the shaft was, from reading to reading by the cubic that has its angles and speeds; for a device that is
/// read at another time than its reference.
class ShaftCourse {
 public:
  /// In the order of time.
  void Add(const AngleMoment& moment);

  /// How far the shaft was beside where it is at `moment`, the last one, `age_s` before that. Of an age below zero:
  /// where it will be if its speed goes on changing as it did for as long a time.
  double Beside_rad(const AngleMoment& moment, double age_s) const;

 private:
  struct Point {
    double time_s, angle_rad, velocity_rad_s;
  };
  static double Between_rad(const Point& a, const Point& b, double time_s);
  double At_rad(double time_s) const;
  double Speed_rad_s(double time_s) const;

  std::vector<Point> points_;
};

}  // namespace twinbench::sim
