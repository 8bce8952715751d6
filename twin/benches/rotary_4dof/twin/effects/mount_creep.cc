#include <cmath>

#include "twin/benches/rotary_4dof/twin/effects/effects.h"

namespace twinbench::sim {
namespace {

/// The grating's mount creeps after every mounting: logarithmic in time, `amplitude` after e - 1 time constants.
class MountCreep : public Effect {
 public:
  explicit MountCreep(const EffectSettings& e)
      : yaw_(e.where == "yaw"),
        amplitude_rad_(Parameter(e, "amplitude")),
        time_constant_s_(Parameter(e, "time_constant")) {}
  void AlterPose(const Moment& moment, PoseState& pose) const override {
    const double angle_rad = amplitude_rad_ * std::log1p(ToSeconds(moment.now - moment.mounted) / time_constant_s_);
    (yaw_ ? pose.grating_yaw_rad : pose.grating_tilt_rad) += angle_rad;
  }

 private:
  bool yaw_;
  double amplitude_rad_;
  double time_constant_s_;
};

}  // namespace

EffectPointer MakeMountCreep(const EffectSettings& settings, const Scenario& /*scenario*/) {
  return std::make_unique<MountCreep>(settings);
}

}  // namespace twinbench::sim
