#include "twin/benches/encoder_comparison/twin/effects/effects.h"
#include "twin/sim/courses.h"

namespace twinbench::sim {
namespace {

/// The device's zero jumps at one reading and stays: a lost line, a coupling that gave way.
class ZeroSlip : public AngleEffect {
 public:
  explicit ZeroSlip(const EffectSettings& e) : effect_(e) {}
  double DeviceError_rad(const AngleMoment& moment, double) const override {
    return StepAt(effect_, moment.reading);
  }

 private:
  EffectSettings effect_;
};

}  // namespace

AngleEffectPointer MakeZeroSlip(const EffectSettings& settings) {
  return std::make_unique<ZeroSlip>(settings);
}

}  // namespace twinbench::sim
