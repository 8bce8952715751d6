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

  /// How it moved at the time that is read: its sense, and its acceleration between the middles of the ways from reading to
  /// reading, behind the last of them as it was there.
  void ReadEarlier(double age_s, AngleMoment& read) const;

 private:
  struct Point {
    double time_s, angle_rad, velocity_rad_s;
    int goes;
    double gains_rad_s2;
  };
  static double Between_rad(const Point& a, const Point& b, double time_s);
  double At_rad(double time_s) const;
  double Speed_rad_s(double time_s) const;
  double Acceleration_rad_s2(std::size_t k) const;

  std::vector<Point> points_;
};

}  // namespace twinbench::sim
