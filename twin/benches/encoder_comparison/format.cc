#include "twin/benches/encoder_comparison/format.h"

#include "twin/benches/names.h"

namespace twinbench::benches::encoder {

const BenchFormat& Format() {
  static const BenchFormat format = {
      .name = kEncoderBench, .title = "an angle device under test against a reference", .add_keys = AddKeys,
      .check_together = CheckTogether, .columns = Columns(), .desired = Desired(), .compared = Compared(),
      .smallest_addition = Addition, .effects = Effects(), .channels = {"angle"}, .points = {"angle"},
      .angles = {"device", "reference"}};
  return format;
}

}  // namespace twinbench::benches::encoder
