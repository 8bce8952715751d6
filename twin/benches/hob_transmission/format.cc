#include "twin/benches/hob_transmission/format.h"

#include "twin/benches/names.h"

namespace twinbench::benches::hob {

const BenchFormat& Format() {
  static const BenchFormat format = {
      .name = kHobBench, .title = "transmission error of a hobbing machine by two ring encoders",
      .add_keys = AddKeys, .check_together = CheckTogether, .columns = Columns(), .desired = Desired(),
      .smallest_addition = Addition, .effects = Effects(), .channels = {"transmission"},
      .points = {"transmission", "interferometer"}, .angles = {"table"}};
  return format;
}

}  // namespace twinbench::benches::hob
