#include "twin/benches/rotary_4dof/twin/effects/effects.h"

namespace twinbench::sim {
namespace {

/// The beam's direction drifts with time, linearly plus a quadratic share that is zero at both ends of the first
/// hour.
class LaserDrift : public Effect {
 public:
  explicit LaserDrift(const EffectSettings& e)
      : yaw_(e.where == "yaw"), drift_rad_s_(Parameter(e, "drift")), curvature_(Parameter(e, "curvature")) {}
  void AlterLight(const Moment& moment, LightState& light) const override {
    const double t_s = ToSeconds(moment.now), hours = t_s / units::hour;
    const double angle_rad = drift_rad_s_ * t_s * (1.0 + curvature_ * (1.0 - hours));
    (yaw_ ? light.yaw_rad : light.pitch_rad) += angle_rad;
  }

 private:
  bool yaw_;
  double drift_rad_s_;
  double curvature_;
};

}  // namespace

EffectPointer MakeLaserDrift(const EffectSettings& settings, const Scenario& /*scenario*/) {
  return std::make_unique<LaserDrift>(settings);
}

}  // namespace twinbench::sim
