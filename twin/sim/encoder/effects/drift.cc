#include "twin/sim/encoder/effects/effects.h"

namespace twinbench::sim {
namespace {

/// The device's zero drifts with time, linearly plus a quadratic share that is zero at both ends of the first hour.
class ZeroDrift : public AngleEffect {
 public:
  explicit ZeroDrift(const EffectSettings& e)
      : rate_rad_s_(Parameter(e, "rate")), curvature_(Parameter(e, "curvature")) {}
  double DeviceError_rad(const AngleMoment& moment, double) const override {
    const double t_s = ToSeconds(moment.now), hours = t_s / units::hour;
    return rate_rad_s_ * t_s * (1.0 + curvature_ * (1.0 - hours));
  }

 private:
  double rate_rad_s_, curvature_;
};

}  // namespace

AngleEffectPointer MakeZeroDrift(const EffectSettings& settings) {
  return std::make_unique<ZeroDrift>(settings);
}

}  // namespace twinbench::sim
