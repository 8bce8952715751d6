#include "twin/benches/circular_motion/format.h"

#include "twin/benches/names.h"

namespace twinbench::benches::circular {

const BenchFormat& Format() {
  static const BenchFormat format = [] {
    BenchFormat f;
    f.name = kCircularBench;
    f.title = "circles of a machine tool under a ball bar with an encoder, and on a grid plate";
    f.add_keys = AddKeys;
    f.check_together = CheckTogether;
    f.columns = Columns();
    f.into_frame = AboutItsCentre;
    // Of the bar and its encoder, or of the two axes of the grid: the deviation from the commanded point.
    f.channels = f.points = {"radial", "tangential"};
    f.angles = {"commanded"};
    f.signal = SignalKind::kPosition;
    f.desired = Desired();
    f.smallest_addition = Addition;
    f.effects = Effects();
    return f;
  }();
  return format;
}

}  // namespace twinbench::benches::circular
