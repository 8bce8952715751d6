#include "mechanics/gear_law.h"

namespace twinbench::mechanics {
namespace {

void Append(const std::vector<AngleHarmonic>& harmonics, double turns, std::vector<AngleHarmonic>& out) {
  for (const AngleHarmonic& h : harmonics) out.push_back({turns * h.order, h.amplitude_rad, h.phase_rad});
}

/// gain x angle + scale x harmonics
AngleSeries Linear(double gain, double angle_rad, double scale, const std::vector<AngleHarmonic>& harmonics) {
  const AngleSeries e = Evaluate(harmonics, angle_rad);
  return {gain * angle_rad + scale * e.value_rad, gain + scale * e.slope, scale * e.bend_1_rad};
}

}  // namespace

GearLaw::GearLaw(const GearTrainParameters& p)
    : ratio_(p.ratio),
      correction_(p.correction),
      hob_encoder_(p.errors.hob_encoder),
      hob_drive_(p.errors.hob_drive) {
  Append(p.errors.worm_wheel, 1.0, wheel_);
  Append(p.errors.worm, p.WormRatio(), wheel_);
  Append(p.errors.tooth_mesh, p.worm_wheel_teeth, wheel_);
}

AngleSeries GearLaw::Wheel(double nominal_rad) const {
  return Linear(1.0, nominal_rad, 1.0, wheel_);
}

AngleSeries GearLaw::Command(double hob_motor_rad) const {
  AngleSeries command = Linear(ratio_, hob_motor_rad, 1.0, hob_encoder_);
  if (!correction_) return command;
  const AngleSeries added = correction_(ratio_ * hob_motor_rad);
  command.value_rad += added.value_rad;
  command.slope += ratio_ * added.slope;
  command.bend_1_rad += ratio_ * ratio_ * added.bend_1_rad;
  return command;
}

// A hob that is behind by error / ratio leaves the table ahead of it by the error.
AngleSeries GearLaw::Spindle(double hob_motor_rad) const {
  return Linear(1.0, hob_motor_rad, -1.0 / ratio_, hob_drive_);
}

}  // namespace twinbench::mechanics
