#include "twin/benches/rotary_4dof/twin/effects/effects.h"
#include "twin/sim/first_order_lag.h"

namespace twinbench::sim {
namespace {

/// A post or the base bends with the room temperature, behind it by a first-order lag.
class ThermalTilt : public Effect {
 public:
  explicit ThermalTilt(const EffectSettings& e)
      : yaw_(e.where == "yaw"), tilt_per_kelvin_rad_(Parameter(e, "tilt_per_kelvin")), post_(Parameter(e, "lag")) {}

  void Advance(const Moment& moment) override {
    lagged_K_ = post_.Follow(ToSeconds(moment.now), moment.temperature_K);
  }
  void AlterPose(const Moment&, PoseState& pose) const override {
    (yaw_ ? pose.grating_yaw_rad : pose.grating_tilt_rad) += tilt_per_kelvin_rad_ * lagged_K_;
  }

 private:
  bool yaw_;
  double tilt_per_kelvin_rad_;
  FirstOrderLag post_;
  double lagged_K_ = 0.0;
};

}  // namespace

EffectPointer MakeThermalTilt(const EffectSettings& settings, const Scenario& /*scenario*/) {
  return std::make_unique<ThermalTilt>(settings);
}

}  // namespace twinbench::sim
