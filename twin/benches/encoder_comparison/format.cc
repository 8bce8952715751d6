#include "twin/benches/encoder_comparison/format.h"

#include "twin/benches/names.h"

namespace twinbench::benches::encoder {

const BenchFormat& Format() {
  static const BenchFormat format = [] {
    BenchFormat f;
    f.name = kEncoderBench;
    f.title = "an angle device under test against a reference";
    f.add_keys = AddKeys;
    f.check_together = CheckTogether;
    f.columns = Columns();
    f.channels = {"angle"};
    f.points = {"angle"};
    f.angles = {"device", "reference"};
    f.desired = Desired();
    f.compared = Compared();
    f.smallest_addition = Addition;
    f.effects = Effects();
    return f;
  }();
  return format;
}

}  // namespace twinbench::benches::encoder
