#include "twin/benches/circular_motion/bench.h"
#include "twin/benches/encoder_comparison/bench.h"
#include "twin/benches/freeform_five_axis/bench.h"
#include "twin/benches/hob_transmission/bench.h"
#include "twin/benches/registry.h"
#include "twin/benches/rotary_4dof/bench.h"
#include "twin/benches/turntable_autocollimator/bench.h"

namespace twinbench {

const std::vector<const Bench*>& Benches() {
  static const std::vector<const Bench*> benches = {&benches::rotary::Whole(), &benches::encoder::Whole(),
                                                    &benches::turntable::Whole(), &benches::hob::Whole(),
                                                    &benches::circular::Whole(), &benches::freeform::Whole()};
  return benches;  // constant
}

}  // namespace twinbench
