#include "twin/benches/rotary_4dof/twin/effects/effects.h"

namespace twinbench::sim {
namespace {

/// The rotor of one table lags behind its encoder by `half_width`, on the side it came from.
class Backlash : public Effect {
 public:
  explicit Backlash(const EffectSettings& e)
      : on_reference_(e.where == "reference"), half_width_rad_(Parameter(e, "half_width")) {}
  void AlterPose(const Moment& moment, PoseState& pose) const override {
    if (on_reference_) {
      pose.reference_yaw_rad -= moment.reference_direction * half_width_rad_;
    } else {
      pose.target_yaw_rad -= moment.target_direction * half_width_rad_;
    }
  }

 private:
  bool on_reference_;
  double half_width_rad_;
};

}  // namespace

EffectPointer MakeBacklash(const EffectSettings& settings, const Scenario& /*scenario*/) {
  return std::make_unique<Backlash>(settings);
}

}  // namespace twinbench::sim
