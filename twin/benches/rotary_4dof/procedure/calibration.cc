#include <algorithm>
#include <array>

#include "twin/benches/rotary_4dof/procedure/sequencer.h"
#include "twin/benches/rotary_4dof/settings.h"

namespace twinbench::procedure {
namespace {

enum class Sweep { kYaw, kTilt };

/// Angle of sweep point `index` of `points` from -limit to +limit.
double SweepAngle_rad(const ProcedureSettings& settings, int index) {
  if (settings.sweep_points < 2) return 0.0;
  return settings.sweep_rad * (2.0 * index / (settings.sweep_points - 1) - 1.0);
}

void SweepOnce(Sequencer& sequencer, Sweep axis, int pass, int direction) {
  const int points = sequencer.settings().sweep_points;
  for (int k = 0; k < points; ++k) {
    const int index = direction > 0 ? k : points - 1 - k;
    const double angle_rad = SweepAngle_rad(sequencer.settings(), index);
    sequencer.Tilt(axis == Sweep::kYaw ? angle_rad : 0.0, axis == Sweep::kTilt ? angle_rad : 0.0);
    Reading stop;
    stop.phase = Phase::kCalibration;
    stop.pass = pass;
    stop.direction = direction;
    stop.position = index;
    sequencer.Take(stop, true);
  }
}

}  // namespace

/// Sweeps the grating in yaw and in tilt about the laser spot, there and back, against the autocollimator: gains of
/// the four channels and the roll of the PSDs follow from it (paper, section 4.1 and eq. 7).
void Calibrate(Sequencer& sequencer) {
  sequencer.Mount(0, 0);
  for (const Sweep axis : {Sweep::kYaw, Sweep::kTilt}) {
    SweepOnce(sequencer, axis, 0, +1);
    SweepOnce(sequencer, axis, 1, -1);
  }
  sequencer.Tilt(0.0, 0.0);
}

int CalibrationReadings(const ProcedureSettings& procedure) {
  return 2 * 2 * procedure.sweep_points;
}

}  // namespace twinbench::procedure
