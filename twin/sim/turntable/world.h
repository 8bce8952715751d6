#pragma once

#include <vector>

#include "optics/autocollimator.h"
#include "twin/core/devices.h"
#include "twin/sim/axes.h"
#include "twin/sim/empirical_signal.h"
#include "twin/sim/environment.h"
#include "twin/sim/turntable/effect.h"
#include "twin/sim/turntable/mirror_stand.h"

namespace twinbench::sim {

/// The whole turntable bench at the time of its event queue. Devices are thin: they ask and change this.
class TurntableWorld {
 public:
  explicit TurntableWorld(const Scenario& nominal);

  EventQueue& queue() { return queue_; }
  Environment& environment() { return environment_; }
  Axes& axes() { return axes_; }
  const Scenario& actual() const { return actual_; }
  const MirrorStand& stand() const { return stand_; }

  void StartMove(double to_rad);
  TableState TurntableState();
  /// Lets the time pass that it takes.
  void IndexTo(int tooth);
  void Mount(int setup, double tilt_rad, double azimuth_rad, double eccentricity_m, int shift_teeth);
  AutocollimatorReading Look();

 private:
  TurntableMoment Moment(int reading);
  Eigen::Vector2d Zero_rad();
  Eigen::Vector2d Noise_rad();

  EventQueue queue_;
  std::vector<std::unique_ptr<TurntableEffect>> effects_;
  Scenario actual_;
  Environment environment_;
  Axes axes_;
  MirrorStand stand_;
  optics::AutocollimatorOptics optics_;
  Stream noise_;
  EmpiricalSignal empirical_x_, empirical_y_;
  Time mounted_{};
  int setup_ = 0;
  int next_reading_ = 0;
};

}  // namespace twinbench::sim
