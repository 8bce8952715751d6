#include "twin/benches/rotary_4dof/procedure/sequencer.h"
#include "twin/benches/rotary_4dof/settings.h"

namespace twinbench::procedure {

/// Compares the bench with the autocollimator at angles that the calibration did not use, in yaw and tilt at once
/// (paper, section 4.3): the points lie between those of the sweep and the two axes run in opposite order.
void Verify(Sequencer& sequencer) {
  sequencer.Mount(0, 0);
  const int points = sequencer.settings().verification_points;
  for (int k = 0; k < points; ++k) {
    const double share = (2.0 * k + 1.0) / points - 1.0;  // -1 < share < 1, never an end of the sweep
    sequencer.Tilt(share * sequencer.settings().sweep_rad, -share * sequencer.settings().sweep_rad);
    Reading stop;
    stop.phase = Phase::kVerification;
    stop.position = k;
    sequencer.Take(stop, true);
  }
  sequencer.Tilt(0.0, 0.0);
}

int VerificationReadings(const ProcedureSettings& procedure) {
  return procedure.verification_points;
}

}  // namespace twinbench::procedure
