#include "twin/benches/rotary_4dof/twin/effects/effects.h"

namespace twinbench::sim {
namespace {

/// Something was knocked at one reading and stays where it went: the grating in yaw or tilt, or along its normal.
class Slip : public Effect {
 public:
  explicit Slip(const EffectSettings& e)
      : where_(e.where), at_reading_(static_cast<int>(Parameter(e, "at_reading"))) {
    size_ = where_ == "lateral" ? Parameter(e, "shift") : Parameter(e, "angle");
  }
  void AlterPose(const Moment& moment, PoseState& pose) const override {
    if (moment.reading < at_reading_) return;
    if (where_ == "yaw") pose.grating_yaw_rad += size_;
    if (where_ == "tilt") pose.grating_tilt_rad += size_;
    if (where_ == "lateral") pose.grating_shift_m += size_;
  }

 private:
  std::string where_;
  int at_reading_;
  double size_;
};

}  // namespace

EffectPointer MakeSlip(const EffectSettings& settings, const Scenario& /*scenario*/) {
  return std::make_unique<Slip>(settings);
}

}  // namespace twinbench::sim
