#pragma once

#include <array>
#include <optional>

#include "twin/benches/rotary_4dof/procedure/procedure.h"
#include "twin/benches/rotary_4dof/settings.h"
#include "twin/core/device_fault.h"
#include "twin/core/stream.h"
#include "twin/procedure/journal.h"
#include "twin/procedure/quiet_bench.h"

namespace twinbench::procedure {

/// How far a run has come, over all attempts.
struct RunState {
  int kept = 0;                    // readings
  std::optional<int> mounted_for;  // reading before which a hand has mounted the grating on a real bench
  bool disturbed = false;          // the bench is not where the last kept reading left it
  bool moved = false;                // by somebody else, it seems
  std::optional<Reading> last = {};  // that was kept since the program was started
};

/// The steps that all phases share: mount, go somewhere, dwell, take one reading.
///
/// The first `state.kept` readings are passed through quietly; then the bench is brought to where the last of them
/// left it and everything happens on it.
class Sequencer {
 public:
  Sequencer(Journal& journal, const Scenario& scenario, ReadingSink& sink, const Options& options,
            const ProgressCallback& progress, RunState& state);

  /// Brings the bench back to its start, if an attempt at the first reading has disturbed it.
  void Begin();

  const ProcedureSettings& settings() const { return RotaryOf(scenario_).procedure; }
  double step_rad() const { return 2.0 * units::kPi / settings().positions; }

  /// Brings the tables to the start of the set-up with this shift, turns the grating back to the PSDs the way
  /// `clamping` says and waits until the mounting has come to rest.
  void Mount(int setup, int shift_steps);

  /// Moves both tables together; the reference counter-rotates so that the grating keeps facing the PSDs.
  void GoTo(double target_rad);

  /// Turns the grating by the goniometer.
  void Tilt(double yaw_rad, double tilt_rad);

  /// Dwells, takes one block and hands the reading on. `stop` carries setup, pass, direction, position and phase.
  void Take(Reading stop, bool with_autocollimator);
  /// The same after a dwell that is not drawn.
  void TakeAfter(Reading stop, double dwell_s, bool with_autocollimator);

 private:
  /// What the controllers are told, so that the tables arrive where they should.
  struct Sent {
    double target_rad, reference_rad;
  };
  Sent SentTo(double target_rad) const;
  void Send(RotaryBench& bench, double target_rad);
  bool quiet() const { return next_reading_ < state_.kept; }
  RotaryBench& bench() { return quiet() ? quiet_devices_ : live_devices_; }
  double DrawDwell_s();
  Acquisition Measure(Reading& stop, double dwell_s, bool with_autocollimator);
  Acquisition TakeBlock(Reading& stop);
  /// Angles [rad] that the encoders of target and reference show; NaN where nobody looks.
  std::array<double, 2> LookAtEncoders();
  void NoteMounting(int setup, double clamp_rad, double reseat_rad);
  void GoLive();
  void RepeatCalls();
  std::optional<DeviceFault> RepeatOnce();
  void ReturnToLastStop();
  void RequireAsBefore(RotaryBench& bench);
  void HomeIfLost(RotaryTable& table, const char* name);

  Journal& journal_;
  const Scenario& scenario_;
  ReadingSink& sink_;
  const Options& options_;
  const ProgressCallback& progress_;
  RunState& state_;
  QuietBench quiet_;
  RotaryBench quiet_devices_ = quiet_.Bench(), live_devices_;
  Stream dwell_;
  int planned_;
  int next_reading_ = 0;
  double shift_rad_ = 0.0, target_rad_ = 0.0, yaw_rad_ = 0.0, tilt_rad_ = 0.0;
  std::array<double, 2> sent_rad_ = {kNaN, kNaN};  // target and reference, by us; NaN: not since the tables may have been moved
  bool has_tilted_ = false;  // the goniometer; a bench whose procedure never does may have none
  Reading last_;
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
