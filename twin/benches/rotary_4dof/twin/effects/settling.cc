#include <algorithm>
#include <cmath>

#include "twin/benches/rotary_4dof/twin/effects/effects.h"
#include "twin/model/block_mean.h"

namespace twinbench::sim {
namespace {

/// The target still creeps to its place after the move: behind by `amplitude` when the move has ended, decaying
/// exponentially. On the way it falls behind in proportion to the way.
class Settling : public Effect {
 public:
  explicit Settling(const EffectSettings& e)
      : amplitude_rad_(Parameter(e, "amplitude")), time_constant_s_(Parameter(e, "time_constant")) {}
  void AlterPose(const Moment& moment, PoseState& pose) const override {
    pose.target_yaw_rad -= moment.target_direction * amplitude_rad_ * ShareBehind(moment);
  }
  double Shortest_s() const override { return time_constant_s_; }

 private:
  double ShareBehind(const Moment& moment) const {
    const Time departed = std::max(moment.departed[0], moment.departed[1]);
    if (moment.now < moment.arrived) return ToSeconds(moment.now - departed) / ToSeconds(moment.arrived - departed);
    const double since_s = ToSeconds(moment.now - moment.arrived) + moment.lag_s;
    return model::DecayMeanBehindPole(since_s, time_constant_s_, moment.averaged_s, moment.lag_s);
  }

  double amplitude_rad_;
  double time_constant_s_;
};

}  // namespace

EffectPointer MakeSettling(const EffectSettings& settings, const Scenario& /*scenario*/) {
  return std::make_unique<Settling>(settings);
}

}  // namespace twinbench::sim
