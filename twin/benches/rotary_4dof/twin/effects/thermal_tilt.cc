#include <cmath>

#include "twin/benches/rotary_4dof/twin/effects/effects.h"

namespace twinbench::sim {
namespace {

/// A post or the base bends with the room temperature, behind it by a first-order lag; it starts in equilibrium.
class ThermalTilt : public Effect {
 public:
  explicit ThermalTilt(const EffectSettings& e)
      : yaw_(e.where == "yaw"),
        tilt_per_kelvin_rad_(Parameter(e, "tilt_per_kelvin")),
        lag_s_(Parameter(e, "lag")) {}

  /// Exact for a temperature that runs linearly between two calls.
  void Advance(const Moment& moment) override {
    if (!started_) {
      started_ = true;
      lagged_K_ = moment.temperature_K;
    } else {
      Follow(moment.temperature_K, ToSeconds(moment.now - last_));
    }
    last_ = moment.now;
    last_K_ = moment.temperature_K;
  }
  void AlterPose(const Moment&, PoseState& pose) const override {
    (yaw_ ? pose.grating_yaw_rad : pose.grating_tilt_rad) += tilt_per_kelvin_rad_ * lagged_K_;
  }

 private:
  void Follow(double temperature_K, double elapsed_s) {
    if (elapsed_s <= 0.0) return;
    const double slope_K_s = (temperature_K - last_K_) / elapsed_s;
    // The lagged value chases a ramp: it stays `slope * lag` behind once the transient has gone.
    const double behind_K = (lagged_K_ - last_K_) + slope_K_s * lag_s_;
    lagged_K_ = temperature_K - slope_K_s * lag_s_ + behind_K * std::exp(-elapsed_s / lag_s_);
  }

  bool yaw_;
  double tilt_per_kelvin_rad_;
  double lag_s_;
  bool started_ = false;
  Time last_{};
  double last_K_ = 0.0;
  double lagged_K_ = 0.0;
};

}  // namespace

EffectPointer MakeThermalTilt(const EffectSettings& settings, const Scenario& /*scenario*/) {
  return std::make_unique<ThermalTilt>(settings);
}

}  // namespace twinbench::sim
