#include <algorithm>

#include "twin/benches/rotary_4dof/procedure/sequencer.h"
#include "twin/benches/rotary_4dof/settings.h"

namespace twinbench::procedure {

/// Reads the resting bench every `stability_interval_s` for `stability_s` (paper, section 4.2).
void TestStability(Sequencer& sequencer) {
  sequencer.Mount(0, 0);
  const int readings = StabilityReadings(sequencer.settings());
  for (int k = 0; k < readings; ++k) {
    Reading stop;
    stop.phase = Phase::kStability;
    stop.position = k;
    sequencer.TakeAfter(stop, sequencer.settings().stability_interval_s, false);
  }
}

int StabilityReadings(const ProcedureSettings& procedure) {
  return std::max(1, static_cast<int>(procedure.stability_s / procedure.stability_interval_s));
}

}  // namespace twinbench::procedure
