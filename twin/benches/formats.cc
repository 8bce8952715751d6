#include "twin/benches/circular_motion/format.h"
#include "twin/benches/encoder_comparison/format.h"
#include "twin/benches/freeform_five_axis/format.h"
#include "twin/benches/hob_transmission/format.h"
#include "twin/benches/rotary_4dof/format.h"
#include "twin/benches/turntable_autocollimator/format.h"

namespace twinbench {

const std::vector<const BenchFormat*>& BenchFormats() {
  static const std::vector<const BenchFormat*> formats = {&benches::rotary::Format(), &benches::encoder::Format(),
                                                          &benches::turntable::Format(), &benches::hob::Format(),
                                                          &benches::circular::Format(), &benches::freeform::Format()};
  return formats;  // constant
}

}  // namespace twinbench
