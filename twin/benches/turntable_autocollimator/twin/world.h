#pragma once

#include "twin/benches/turntable_autocollimator/twin/mirror_path.h"
#include "twin/core/machine.h"
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
  bool Settles(Duration within) { return axes_.Settles(mechanics::Axis::kTarget, within); }
  void Stop() { axes_.Stop(mechanics::Axis::kTarget); }
  AxisState TurntableState();
  /// Lets the time pass that it takes.
  void IndexTo(int tooth);
  void Mount(int setup);
  /// What the autocollimator shows for the next reading; lets the time pass that its frames take.
  AutocollimatorReading Look();
  Time ReadAt() const { return read_at_; }
  /// What one frame shows on the way there.
  AutocollimatorReading LookOnTheWay();

 private:
  TurntableMoment Moment(int reading);
  void SeatFace();
  double EncoderNoise_rad();
  AutocollimatorReading Shown(Stream& noise, double noise_rad);

  EventQueue queue_;
  MirrorPath path_;
  Environment environment_;
  Axes axes_;
  Stream noise_, null_noise_, encoder_noise_;
  double encoder_noise_rad_ = 0.0;  // of the next reading
  int encoder_noises_ = 0;          // drawn so far
  Time mounted_{}, read_at_{};
  int setup_ = 0;
  int next_reading_ = 0;
};

}  // namespace twinbench::sim
