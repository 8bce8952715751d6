#include <cmath>

#include "twin/benches/rotary_4dof/twin/effects/effects.h"

namespace twinbench::sim {
namespace {

/// The target still creeps to its place after the move: behind by `amplitude`, decaying exponentially.
class Settling : public Effect {
 public:
  explicit Settling(const EffectSettings& e)
      : amplitude_rad_(Parameter(e, "amplitude")), time_constant_s_(Parameter(e, "time_constant")) {}
  void AlterPose(const Moment& moment, PoseState& pose) const override {
    const double since_s = ToSeconds(moment.now - moment.arrived);
    pose.target_yaw_rad -= moment.target_direction * amplitude_rad_ * std::exp(-since_s / time_constant_s_);
  }

 private:
  double amplitude_rad_;
  double time_constant_s_;
};

}  // namespace

EffectPointer MakeSettling(const EffectSettings& settings, const Scenario& /*scenario*/) {
  return std::make_unique<Settling>(settings);
}

}  // namespace twinbench::sim
