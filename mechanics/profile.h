#pragma once

namespace twinbench::mechanics {

/// Angle, speed and acceleration at one instant of a motion.
struct ProfilePoint {
  double position_rad = 0.0;
  double velocity_rad_s = 0.0;
  double acceleration_rad_s2 = 0.0;
};

/// Motion to rest. From rest along the polynomial of fifth degree 10 s^3 - 15 s^4 + 6 s^5, s = time/duration: the
/// lowest degree whose speed and acceleration vanish at both ends. Peak speed 1.875 and peak acceleration 5.774 in
/// units of travel/duration and travel/duration^2.
class QuinticProfile {
 public:
  /// Rests at `position_rad` for ever.
  explicit QuinticProfile(double position_rad);

  /// @throws std::invalid_argument unless both positions are finite and the duration is positive.
  QuinticProfile(double from_rad, double to_rad, double duration_s);

  /// Brings a motion to rest: the polynomial of fifth degree that begins with `from`, all three of it.
  QuinticProfile(const ProfilePoint& from, double to_rad, double duration_s);

  /// Before the start it rests at `from`, after the end at `to`, exactly.
  ProfilePoint At(double time_s) const;

  double to_rad() const { return to_rad_; }
  double travel_rad() const { return to_rad_ - from_rad_; }
  double duration_s() const { return duration_s_; }
  bool from_rest() const { return entry_rad_ == 0.0 && entry_bend_rad_ == 0.0; }

 private:
  ProfilePoint EntryAt(double s) const;

  double from_rad_;
  double to_rad_;
  double duration_s_;
  double entry_rad_ = 0.0;       // velocity at the start times the duration
  double entry_bend_rad_ = 0.0;  // acceleration at the start times its square
};

}  // namespace twinbench::mechanics
