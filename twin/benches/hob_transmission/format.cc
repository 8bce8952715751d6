#include "twin/benches/hob_transmission/format.h"

#include "twin/benches/names.h"

namespace twinbench::benches::hob {

const BenchFormat& Format() {
  static const BenchFormat format = [] {
    BenchFormat f;
    f.name = kHobBench;
    f.title = "transmission error of a hobbing machine by two ring encoders";
    f.add_keys = AddKeys;
    f.check_together = CheckTogether;
    f.columns = Columns();
    f.channels = {"transmission"};
    f.points = {"transmission", "interferometer"};
    f.angles = {"table"};
    f.desired = Desired();
    f.smallest_addition = Addition;
    f.effects = Effects();
    return f;
  }();
  return format;
}

}  // namespace twinbench::benches::hob
