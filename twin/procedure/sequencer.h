#pragma once

#include "twin/core/stream.h"
#include "twin/procedure/procedure.h"

namespace twinbench::procedure {

/// The steps that all phases share: mount, go somewhere, dwell, take one reading.
class Sequencer {
 public:
  Sequencer(RotaryBench& bench, const Scenario& scenario, ReadingSink& sink, const ProgressCallback& progress);

  const ProcedureSettings& settings() const { return scenario_.procedure; }
  double step_rad() const { return 2.0 * units::kPi / settings().positions; }

  /// Brings the tables to the start of the set-up with this shift, turns the grating back to the PSDs the way
  /// `clamping` says and waits until the mounting has come to rest.
  void Mount(int setup, int shift_steps);

  /// Moves both tables together; the reference counter-rotates so that the grating keeps facing the PSDs.
  void GoTo(double target_rad);

  /// Dwells, takes one block and hands the reading on. `stop` carries setup, pass, direction, position and phase.
  void Take(Reading stop, bool with_autocollimator);
  /// The same after a dwell that is not drawn.
  void TakeAfter(Reading stop, double dwell_s, bool with_autocollimator);

  RotaryBench& bench() { return bench_; }

 private:
  double DrawDwell_s();

  RotaryBench& bench_;
  const Scenario& scenario_;
  ReadingSink& sink_;
  const ProgressCallback& progress_;
  Stream dwell_;
  int planned_;
  int next_reading_ = 0;
  double shift_rad_ = 0.0;
  double target_rad_ = 0.0;
};

void Calibrate(Sequencer& sequencer);
void TestStability(Sequencer& sequencer);
void Verify(Sequencer& sequencer);
void TestFullCircle(Sequencer& sequencer);

int CalibrationReadings(const ProcedureSettings& procedure);
int StabilityReadings(const ProcedureSettings& procedure);
int VerificationReadings(const ProcedureSettings& procedure);
int FullCircleReadings(const ProcedureSettings& procedure);

}  // namespace twinbench::procedure
