#pragma once

#include <optional>
#include <vector>

#include "twin/core/machine.h"

namespace twinbench::sim {

/// A share of the way at a time; between two of them it goes steadily.
struct PathKnot {
  Time time{};
  double share = 0.0;
};

/// From one place to another, along a line or an arc, or round an axis from speed to speed.
class DrivenPath {
 public:
  DrivenPath() = default;
  static DrivenPath Resting(std::vector<double> at, Time now);
  static DrivenPath Line(std::vector<double> from, std::vector<double> to, Time begin, Duration takes);
  /// @param knots  Its times; not empty.
  static DrivenPath Circular(std::vector<double> from, const Arc& arc, std::vector<PathKnot> knots);
  /// Of a machine of one axis: at constant acceleration within `ramp` to a speed, which it then keeps. It ends only at speed 0.
  static DrivenPath Turning(double from_rad, double from_speed_rad_s, double speed_rad_s, Time begin, Duration ramp);

  Time End() const { return knots_.back().time; }
  const std::vector<double>& to() const { return to_; }
  std::vector<double> At(Time now) const;
  std::vector<double> AtShare(double share) const;
  /// Of an axis that turns; 0 along lines and arcs.
  double TurningSpeed_rad_s(Time now) const;

 private:
  struct Turn {
    double from_rad, from_speed_rad_s, speed_rad_s;
    Time begin;
    double ramp_s;
  };
  double Share(Time now) const;
  std::vector<double> OnArc(double share) const;
  static double Turned_rad(const Turn& turn, Time now);

  std::vector<double> from_, to_;
  std::optional<Arc> arc_;
  std::optional<Turn> turn_;
  std::vector<PathKnot> knots_;
};

}  // namespace twinbench::sim
