#include "twin/benches/hob_transmission/twin/path.h"

#include <algorithm>
#include <cmath>

#include "twin/benches/hob_transmission/settings.h"
#include "twin/sim/actual_bench.h"

namespace twinbench::sim {
namespace {

std::vector<std::unique_ptr<HobEffect>> HobEffectsOf(const Scenario& nominal) {
  std::vector<std::unique_ptr<HobEffect>> effects;
  for (const EffectSettings& effect : BeyondKeys(nominal)) effects.push_back(MakeHobEffect(effect, nominal));
  return effects;
}

mechanics::GearTrainParameters TrainOf(const Scenario& actual,
                                       const std::vector<std::unique_ptr<HobEffect>>& effects) {
  const TransmissionSettings& t = HobOf(actual).transmission;
  mechanics::GearTrainParameters p;
  p.ratio = t.Ratio();
  p.worm_wheel_teeth = t.worm_wheel_teeth;
  p.worm_starts = t.worm_starts;
  p.motor.servo_Hz = t.servo_Hz;
  p.motor.feed_forward = t.feed_forward;
  p.hob.feed_forward = 1.0;
  p.table_inertia_kg_m2 = t.table_inertia_kg_m2;
  p.stiffness_Nm_rad = t.stiffness_Nm_rad;
  p.damping_ratio = t.damping_ratio;
  p.friction.coulomb_Nm = t.friction_Nm;
  p.backlash_rad = t.backlash_rad;
  constexpr double kStepsAPeriodOfTheServo = 40.0;  // its loop is stable with no fewer
  const double fastest_Hz = std::max(p.motor.servo_Hz, p.hob.servo_Hz);
  p.servo_period_s = std::min(p.servo_period_s, 1.0 / (kStepsAPeriodOfTheServo * fastest_Hz));
  for (const HarmonicSettings& h : t.harmonics) p.errors.worm_wheel.push_back({h.order, h.amplitude, h.phase_rad});
  for (const auto& effect : effects) effect->AlterGears(p.errors);
  if (t.compensation) {
    p.correction = [table = *t.compensation](double table_rad) {
      return mechanics::AngleSeries{table.At(table_rad), table.SlopeAt(table_rad), 0.0};
    };
  }
  return p;
}

void SilenceHob(HobSettings& own) {
  own.table_encoder.noise_rad = 0.0;
  own.hob_encoder.noise_rad = 0.0;
  own.interferometer.noise_rad = 0.0;
}

}  // namespace

HobPath::HobPath(const Scenario& nominal)
    : effects_(HobEffectsOf(nominal)),
      actual_(ActualBenchOf(nominal, effects_, SilenceHob)),
      train_(TrainOf(actual_, effects_)),
      empirical_(actual_.empiricals, "transmission") {
  for (const HarmonicSettings& h : HobOf(actual_).interferometer.calibrator)
    calibrator_.push_back({h.order, h.amplitude, h.phase_rad});
}

mechanics::SignalState HobPath::HobSignals() const {
  mechanics::SignalState signals;
  for (const auto& effect : effects_) effect->AlterHobSignals(signals);
  return signals;
}

double HobPath::Interferometer_rad(double table_rad, double hob_rad, double velocity_rad_s, Time now) const {
  const InterferometerSettings& i = HobOf(actual_).interferometer;
  if (!i.used || (i.IsReadAtRest() && velocity_rad_s != 0.0)) return kNaN;
  const double deviation_rad = table_rad - HobOf(actual_).transmission.Ratio() * hob_rad +
                               mechanics::Evaluate(calibrator_, table_rad).value_rad;
  // Optical difference of the paths: arm * deviation along the beam, and the dead path in air that changes.
  const double index_change = i.index_drift_per_h * ToSeconds(now) / units::hour;
  const double difference_m =
      (i.arm_m + i.arm_error_m) * deviation_rad * std::cos(i.misalignment_rad) * (1.0 + index_change) +
      i.dead_path_m * index_change;
  return difference_m / i.arm_m;
}

void HobPath::Travel(double table_rad) {
  for (const auto& effect : effects_) effect->Travel(table_rad);
}

void HobPath::Disturb(const HobMoment& moment, CounterSample& sample) {
  for (const auto& effect : effects_) {
    const ShownError error = effect->Shown(moment);
    sample.table_encoder_rad += error.table_rad + error.motion_rad;
    sample.interferometer_rad += error.motion_rad + error.interferometer_rad;
    sample.hob_encoder_rad += error.hob_rad;
  }
  sample.table_encoder_rad += empirical_.At(moment.reading, ToSeconds(moment.now));
}

std::vector<mechanics::AngleHarmonic> HobPath::Transmission() const {
  const mechanics::GearErrors& errors = train_.errors;
  std::vector<mechanics::AngleHarmonic> by_table = errors.worm_wheel;
  const auto add = [&](const std::vector<mechanics::AngleHarmonic>& part, double turns) {
    for (const mechanics::AngleHarmonic& h : part)
      by_table.push_back({h.order * turns, h.amplitude_rad, h.phase_rad});
  };
  add(errors.worm, HobOf(actual_).transmission.WormOrder());
  add(errors.hob_drive, HobOf(actual_).transmission.HobOrder());
  return by_table;
}

}  // namespace twinbench::sim
