#pragma once

#include "twin/benches/turntable_autocollimator/twin/mirror_path.h"
#include "twin/core/devices.h"
#include "twin/sim/axes.h"
#include "twin/sim/environment.h"

namespace twinbench::sim {

/// The whole turntable bench at the time of its event queue. Devices are thin: they ask and change this.
class TurntableWorld {
 public:
  explicit TurntableWorld(const Scenario& nominal);

  EventQueue& queue() { return queue_; }
  Environment& environment() { return environment_; }
  Axes& axes() { return axes_; }
  const Scenario& actual() const { return path_.actual(); }
  const MirrorStand& stand() const { return path_.stand(); }

  void StartMove(double to_rad);
  TableState TurntableState();
  /// Lets the time pass that it takes.
  void IndexTo(int tooth);
  void Mount(int setup, double tilt_rad, double azimuth_rad, double eccentricity_m, int shift_teeth);
  AutocollimatorReading Look();
  /// As NullServo says.
  bool Null(int direction);

 private:
  TurntableMoment Moment(int reading);
  void SeatFace();
  bool Turn(double to_rad);
  /// What the instrument shows now, for the next reading or on the way to it.
  AutocollimatorReading Shown(Stream& noise);

  EventQueue queue_;
  MirrorPath path_;
  Environment environment_;
  Axes axes_;
  Stream noise_, null_noise_, encoder_noise_;
  Time mounted_{};
  int setup_ = 0;
  int next_reading_ = 0;
};

}  // namespace twinbench::sim
