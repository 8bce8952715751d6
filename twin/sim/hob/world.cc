#include "twin/sim/hob/world.h"

#include <algorithm>

#include "twin/core/device_fault.h"
#include "twin/sim/silence.h"

namespace twinbench::sim {
namespace {

std::vector<std::unique_ptr<HobEffect>> HobEffectsOf(const Scenario& nominal) {
  std::vector<std::unique_ptr<HobEffect>> effects;
  for (const EffectSettings& effect : nominal.effects) effects.push_back(MakeHobEffect(effect, nominal));
  return effects;
}

Scenario ActualBench(const Scenario& nominal, const std::vector<std::unique_ptr<HobEffect>>& effects) {
  Scenario actual = nominal;
  for (const auto& effect : effects) effect->AlterBench(actual);
  if (actual.noise_free) Silence(actual);
  return actual;
}

mechanics::GearTrainParameters TrainOf(const Scenario& actual,
                                       const std::vector<std::unique_ptr<HobEffect>>& effects) {
  const TransmissionSettings& t = actual.transmission;
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
  return p;
}

mechanics::SignalState HobSignals(const std::vector<std::unique_ptr<HobEffect>>& effects) {
  mechanics::SignalState signals;
  for (const auto& effect : effects) effect->AlterHobSignals(signals);
  return signals;
}

/// Short enough for the cubic between two states: a line of 10 Hz is met to 1e-6 of its size.
Duration PieceOf(const Scenario& actual) {
  return actual.mechanics.fidelity == "bullet" ? std::chrono::milliseconds(1) : std::chrono::milliseconds(2);
}

}  // namespace

HobWorld::HobWorld(const Scenario& nominal)
    : effects_(HobEffectsOf(nominal)),
      actual_(ActualBench(nominal, effects_)),
      train_(mechanics::MakeGearTrain(mechanics::FidelityFromName(actual_.mechanics.fidelity),
                                      TrainOf(actual_, effects_))),
      counters_(actual_, HobSignals(effects_)),
      interferometer_noise_(actual_.seed, "interferometer.noise"),
      empirical_(actual_.empiricals, "transmission"),
      piece_(PieceOf(actual_)) {}

void HobWorld::Run(double hob_speed_rad_s, Duration ramp) {
  if (hob_speed_rad_s != 0.0) direction_ = (hob_speed_rad_s > 0.0) == (actual_.transmission.Ratio() > 0.0) ? 1 : -1;
  hob_speed_rad_s_ = hob_speed_rad_s;
  constexpr Duration kRinging = std::chrono::seconds(5);  // 20 Hz servo, torsion with 1 % of damping: long over
  at_rest_ = now_ + ramp + kRinging;
  train_->Run(hob_speed_rad_s, ToSeconds(ramp));
}

void HobWorld::Mount(double head_rad) {
  if (hob_speed_rad_s_ != 0.0)
    throw DeviceFault(FaultKind::kRefused, "fixture", "nothing can be mounted while the table turns");
  counters_.SetHead(head_rad);
}

void HobWorld::Arm(int edges, int samples) {
  counters_.Arm(edges, samples, train_->State().table_rad, direction_);
}

void HobWorld::RunUntil(Time until) {
  while (now_ < until) {
    if (StandsStill()) {
      now_ = until;
      return;
    }
    // While nothing is counted, time may pass in one piece.
    const Time end = hob_speed_rad_s_ == 0.0 ? std::min(until, at_rest_) : until;
    const Duration piece = counters_.Armed() ? std::min<Duration>(piece_, end - now_) : end - now_;
    const mechanics::GearTrainState before = train_->State();
    train_->Advance(ToSeconds(piece));
    const mechanics::GearTrainState after = train_->State();
    if (counters_.Armed()) TakeSamples(before, after);
    for (const auto& effect : effects_) effect->Travel(after.table_rad);
    now_ += piece;
  }
}

void HobWorld::TakeSamples(const mechanics::GearTrainState& before, const mechanics::GearTrainState& after) {
  while (counters_.Armed()) {
    const auto time_s = mechanics::PassingTime_s(before, after, counters_.NextTableAngle_rad());
    if (!time_s) return;
    const Time then = now_ + FromSeconds(*time_s - before.time_s);  // the train's clock stands still with it
    counters_.Push(SampleAt(mechanics::Between(before, after, *time_s), then));
  }
}

double HobWorld::Interferometer_rad(const mechanics::GearTrainState& at) {
  if (!actual_.interferometer.used) return kNaN;
  const double noise_rad = actual_.interferometer.noise_rad;
  return at.table_rad - actual_.transmission.Ratio() * at.hob_rad +
         (noise_rad > 0.0 ? noise_rad * interferometer_noise_.Normal() : 0.0);
}

CounterSample HobWorld::SampleAt(const mechanics::GearTrainState& at, Time now) {
  CounterSample sample = counters_.Count(at);
  sample.time = now;
  sample.velocity_rad_s = actual_.transmission.Ratio() * hob_speed_rad_s_;
  sample.interferometer_rad = Interferometer_rad(at);
  for (const auto& effect : effects_) effect->Travel(at.table_rad);
  const HobMoment moment{sample.time, next_reading_++, at.table_rad, sample.velocity_rad_s};
  for (const auto& effect : effects_) {
    const ShownError error = effect->Shown(moment);
    sample.table_encoder_rad += error.table_rad + error.motion_rad;
    sample.interferometer_rad += error.motion_rad;
    sample.hob_encoder_rad += error.hob_rad;
  }
  sample.table_encoder_rad += empirical_.At_rad(moment.reading);
  return sample;
}

std::vector<mechanics::AngleHarmonic> HobWorld::Transmission() const {
  const mechanics::GearErrors errors = TrainOf(actual_, effects_).errors;
  std::vector<mechanics::AngleHarmonic> by_table = errors.worm_wheel;
  const auto add = [&](const std::vector<mechanics::AngleHarmonic>& part, double turns) {
    for (const mechanics::AngleHarmonic& h : part)
      by_table.push_back({h.order * turns, h.amplitude_rad, h.phase_rad});
  };
  add(errors.worm, actual_.transmission.WormOrder());
  add(errors.hob_drive, actual_.transmission.HobOrder());
  return by_table;
}

}  // namespace twinbench::sim
