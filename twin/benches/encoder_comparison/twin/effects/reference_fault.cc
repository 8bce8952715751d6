#include <cmath>

#include "twin/benches/encoder_comparison/twin/effects/effects.h"

namespace twinbench::sim {
namespace {

/// The reference shows amplitude * cos(order * its angle + phase) too much. The device knows nothing of it, and a
/// device turned on the shaft does not turn it along.
class ReferenceFault : public AngleEffect {
 public:
  explicit ReferenceFault(const EffectSettings& e)
      : order_(Parameter(e, "order")),
        amplitude_rad_(Parameter(e, "amplitude")),
        phase_rad_(Parameter(e, "phase")) {}
  double ReferenceError_rad(const AngleMoment& moment) const override {
    return amplitude_rad_ * std::cos(order_ * moment.shaft_rad + phase_rad_);
  }

 private:
  double order_, amplitude_rad_, phase_rad_;
};

}  // namespace

AngleEffectPointer MakeReferenceFault(const EffectSettings& settings) {
  return std::make_unique<ReferenceFault>(settings);
}

}  // namespace twinbench::sim
