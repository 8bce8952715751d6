#include "twin/benches/rotary_4dof/procedure/sequencer.h"
#include "twin/benches/rotary_4dof/settings.h"

namespace twinbench::procedure {
namespace {

/// Where the passes of one set-up have brought the target, in whole steps: the tables never rewind between passes
/// of the same direction, so that every stop is reached the same way and bearings see consecutive turns.
class Turns {
 public:
  explicit Turns(int positions) : positions_(positions) {}

  /// Unwrapped step of the k-th stop of a pass in this direction.
  int Step(int direction, int k) const { return direction > 0 ? base_ + k : base_ + positions_ - 1 - k; }
  void BeginPass(int direction) {
    if (direction == last_direction_) base_ += direction * positions_;
    last_direction_ = direction;
  }

 private:
  int positions_;
  int base_ = 0;
  int last_direction_ = 0;
};

int PositionOf(int step, int positions) {
  return ((step % positions) + positions) % positions;
}

void RunPass(Sequencer& sequencer, const Turns& turns, int setup, int pass, int direction) {
  const int positions = sequencer.settings().positions;
  const double step_rad = sequencer.step_rad();
  // Approaching the first stop from behind takes up backlash and wind-up as at every other stop.
  sequencer.GoTo((turns.Step(direction, 0) - direction * sequencer.settings().run_up_steps) * step_rad);
  for (int k = 0; k < positions; ++k) {
    const int step = turns.Step(direction, k);
    sequencer.GoTo(step * step_rad);
    Reading stop;
    stop.phase = Phase::kFullCircle;
    stop.setup = setup;
    stop.pass = pass;
    stop.direction = direction;
    stop.position = PositionOf(step, positions);
    sequencer.Take(stop, false);
  }
}

}  // namespace

/// The full-circle test with any list of shifts, passes and directions. The paper's own is shifts {0, 1}, one pass:
/// its eq. 14-15, with the target counter-clockwise positive.
void TestFullCircle(Sequencer& sequencer) {
  const ProcedureSettings& settings = sequencer.settings();
  for (std::size_t setup = 0; setup < settings.shifts.size(); ++setup) {
    sequencer.Mount(static_cast<int>(setup), settings.shifts[setup]);
    Turns turns(settings.positions);
    for (std::size_t pass = 0; pass < settings.passes.size(); ++pass) {
      turns.BeginPass(settings.passes[pass]);
      RunPass(sequencer, turns, static_cast<int>(setup), static_cast<int>(pass), settings.passes[pass]);
    }
  }
}

int FullCircleReadings(const ProcedureSettings& procedure) {
  return static_cast<int>(procedure.shifts.size() * procedure.passes.size()) * procedure.positions;
}

}  // namespace twinbench::procedure
