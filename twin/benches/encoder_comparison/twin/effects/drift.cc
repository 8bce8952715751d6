#include <cmath>

#include "twin/benches/encoder_comparison/twin/effects/effects.h"
#include "twin/core/units.h"

namespace twinbench::sim {
namespace {

/// The device's zero drifts with time; one that warms up settles.
class ZeroDrift : public AngleEffect {
 public:
  explicit ZeroDrift(const EffectSettings& e)
      : rate_rad_s_(Parameter(e, "rate")),
        curvature_(Parameter(e, "curvature")),
        warm_up_s_(Parameter(e, "warm_up")) {}
  double DeviceError_rad(const AngleMoment& moment, double) const override {
    const double t_s = ToSeconds(moment.now);
    if (warm_up_s_ > 0.0) return -rate_rad_s_ * warm_up_s_ * std::expm1(-t_s / warm_up_s_);
    return rate_rad_s_ * t_s * (1.0 + curvature_ * (1.0 - t_s / units::hour));
  }

 private:
  double rate_rad_s_, curvature_, warm_up_s_;
};

}  // namespace

AngleEffectPointer MakeZeroDrift(const EffectSettings& settings) {
  return std::make_unique<ZeroDrift>(settings);
}

}  // namespace twinbench::sim
