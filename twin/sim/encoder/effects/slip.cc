#include "twin/sim/encoder/effects/effects.h"

namespace twinbench::sim {
namespace {

/// The device's zero jumps at one reading and stays: a lost line, a coupling that gave way.
class ZeroSlip : public AngleEffect {
 public:
  explicit ZeroSlip(const EffectSettings& e)
      : step_rad_(Parameter(e, "step")), at_reading_(static_cast<int>(Parameter(e, "at_reading"))) {}
  double DeviceError_rad(const AngleMoment& moment, double) const override {
    return moment.reading < at_reading_ ? 0.0 : step_rad_;
  }

 private:
  double step_rad_;
  int at_reading_;
};

}  // namespace

AngleEffectPointer MakeZeroSlip(const EffectSettings& settings) {
  return std::make_unique<ZeroSlip>(settings);
}

}  // namespace twinbench::sim
