#include "twin/benches/encoder_comparison/twin/effects/effects.h"
#include "twin/sim/courses.h"

namespace twinbench::sim {
namespace {

/// The device's zero drifts with time.
class ZeroDrift : public AngleEffect {
 public:
  explicit ZeroDrift(const EffectSettings& e) : effect_(e) {}
  double DeviceError_rad(const AngleMoment& moment, double) const override { return DriftAt(effect_, moment.now); }

 private:
  EffectSettings effect_;
};

}  // namespace

AngleEffectPointer MakeZeroDrift(const EffectSettings& settings) {
  return std::make_unique<ZeroDrift>(settings);
}

}  // namespace twinbench::sim
