#include "twin/benches/circular_motion/format.h"

#include "twin/benches/names.h"

namespace twinbench::benches::circular {

const BenchFormat& Format() {
  // Of the bar and its encoder, or of the two axes of the grid: the deviation from the commanded point.
  static const BenchFormat format = {
      .name = kCircularBench,
      .title = "circles of a machine tool under a ball bar with an encoder, and on a grid plate",
      .add_keys = AddKeys, .check_together = CheckTogether, .columns = Columns(), .into_frame = AboutItsCentre,
      .desired = Desired(), .smallest_addition = Addition, .effects = Effects(),
      .channels = {"radial", "tangential"}, .points = {"radial", "tangential"}, .angles = {"commanded"},
      .signal = SignalKind::kPosition};
  return format;
}

}  // namespace twinbench::benches::circular
