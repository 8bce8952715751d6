#pragma once

#include <vector>

#include "twin/core/machine.h"

namespace twinbench::procedure {

/// What an axis that turns on and on was told, against what its encoder shows: speed and direction, from look to look.
class Turning {
 public:
  /// It was told, between two instants, to go over to a speed within `ramp`.
  void Told(Time before, Time after, double speed_rad_s, Duration ramp);
  /// What its encoder showed between two instants.
  /// @param axis  For the message.
  /// @throws DeviceFault kStalled for an axis that stands where it should turn; kFollowing for one whose way since the look before
  ///         is not that of its speed, within a tenth and what the times leave open.
  void Look(const MachineAxis& axis, double encoder_rad, Time before, Time after);
  bool WasTold() const { return !told_.empty(); }

 private:
  struct Command {
    double at_s = 0.0, ramp_s = 0.0, from_rad_s = 0.0, to_rad_s = 0.0, late_s = 0.0;  // late: it was heard by so much later at most
  };
  struct Shown {
    double encoder_rad = kNaN, at_s = 0.0, late_s = 0.0;
  };

  static double SpeedAt(const Command& command, double at_s);
  /// Between two looks: as told, with ramps that are straight.
  double Way_rad(double from_s, double to_s) const;
  double Slack_rad(const Shown& now) const;

  std::vector<Command> told_;  // the last before the last look, and those since
  Shown last_;
};

}  // namespace twinbench::procedure
