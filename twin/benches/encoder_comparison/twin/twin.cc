#include "twin/benches/encoder_comparison/twin/twin.h"

#include <Eigen/Core>
#include <cmath>
#include <nlohmann/json.hpp>

#include "twin/benches/encoder_comparison/settings.h"
#include "twin/core/reading_column.h"
#include "twin/core/stream.h"
#include "twin/sim/truth.h"

namespace twinbench::sim {
namespace {

/// A stop is approached in its direction over half the way from its neighbour.
double RunUp_rad(const EncoderProcedureSettings& procedure) {
  return procedure.kind == "stops" ? units::kPi / procedure.stops : 0.0;
}

/// @param above_K  Of the temperature; NaN: not known.
AngleMoment MomentOf(const Reading& reading, double run_up_rad, double above_K) {
  const auto known = [](double value) { return std::isfinite(value) ? value : 0.0; };
  return {reading.time,          reading.setup,
          reading.reading,       reading.reference_rad,
          known(reading.velocity_rad_s), reading.direction * run_up_rad,
          known(above_K),        known(reading.velocity_rad_s) != 0.0 ? reading.direction : 0};
}

bool Changes(const EnvironmentSettings& room) {
  return room.drift_K_h != 0.0 || room.swing_K != 0.0 || room.random_walk_K_sqrt_h != 0.0 || !room.temperature_file.empty();
}

double Quantised(double angle_rad, double step_rad) {
  return step_rad > 0.0 ? step_rad * std::round(angle_rad / step_rad) : angle_rad;
}

/// Mean of what the device shows at a stop, each time with other noise and in its own steps.
double ReadDevice_rad(const Scenario& scenario, int reading, double angle_rad) {
  const DeviceSettings& device = EncoderOf(scenario).device;
  const auto count = static_cast<std::uint64_t>(EncoderOf(scenario).encoder_procedure.ReadingsAtOnce());
  Stream stream(scenario.RunSeed(), "device.noise");
  stream.Seek(static_cast<std::uint64_t>(reading) * count);
  double sum_rad = 0.0;
  for (std::uint64_t k = 0; k < count; ++k)
    sum_rad += Quantised(angle_rad + device.noise_rad * stream.Normal(), device.resolution_rad);
  return sum_rad / static_cast<double>(count);
}

/// Of what the reference shows at one instant, whatever the count of heads that are read then.
double ReferenceNoise(const Scenario& scenario, int reading) {
  const EncoderProcedureSettings& procedure = EncoderOf(scenario).encoder_procedure;
  if (procedure.reference_noise_rad == 0.0) return 0.0;
  const auto count = static_cast<std::uint64_t>(procedure.ReadingsAtOnce());
  Stream stream(scenario.RunSeed(), "reference.noise");
  stream.Seek(static_cast<std::uint64_t>(reading) / procedure.heads_rad.size() * count);
  double noise_rad = 0.0;
  for (std::uint64_t k = 0; k < count; ++k) noise_rad += stream.Normal();
  return procedure.reference_noise_rad * noise_rad / static_cast<double>(count);
}

/// A function of the angle at every degree, its mean taken out.
template <class Error>
nlohmann::json CurveOf(Error error_rad) {
  constexpr int kPositions = 360;
  Eigen::ArrayXd values(kPositions), positions_deg(kPositions);
  for (int k = 0; k < kPositions; ++k) {
    positions_deg[k] = k;
    values[k] = error_rad(k * units::deg) / units::arcsec;
  }
  values -= values.mean();
  return {{"position_deg", positions_deg}, {"ez_arcsec", values}};
}

}  // namespace

EncoderTwin::EncoderTwin(const Scenario& scenario)
    : EncoderTwin(scenario, RunUp_rad(EncoderOf(scenario).encoder_procedure)) {}

EncoderTwin::EncoderTwin(const Scenario& scenario, double run_up_rad)
    : scenario_(scenario),
      run_up_rad_(run_up_rad),
      signal_zero_rad_(EncoderOf(scenario).device.signal_zero_rad),
      graduation_(scenario),
      spindle_(EncoderOf(scenario)),
      empirical_(scenario.empiricals, "angle") {
  if (Changes(scenario.environment)) room_.emplace(scenario.environment, scenario.RunSeed());
  static const AngleMakers makers = Merged(ShaftEffects(), ReadingEffects());
  for (const EffectSettings& effect : scenario.effects) effects_.push_back(MakeBy(makers, effect, scenario));
  for (const auto& effect : effects_) {
    effect->AlterSignals(signals_);
    signal_zero_rad_ += effect->SignalZero_rad();
  }
}

/// As the head of the set-up sees it. A record of somebody else may have more set-ups than the scenario: where the
/// device stood then is unknown.
double EncoderTwin::MountingOf_rad(int setup) const {
  const EncoderProcedureSettings& s = EncoderOf(scenario_).encoder_procedure;
  const std::size_t heads = s.heads_rad.size(), at = static_cast<std::size_t>(setup) / heads;
  const double mounting_rad = at < s.mounting_rad.size() ? s.mounting_rad[at] : 0.0;
  return mounting_rad - s.heads_rad[static_cast<std::size_t>(setup) % heads];
}

void EncoderTwin::Advance(const AngleMoment& moment) {
  course_.Add(moment);
  for (const auto& effect : effects_) effect->Advance(moment);
}

/// Of the device's shaft, as its scale counts. What is read late shows the errors of where the shaft was.
double EncoderTwin::ShaftAngle_rad(const AngleMoment& moment) const {
  double age_s = 0.0, behind_rad = 0.0;
  for (const auto& effect : effects_) {
    age_s += effect->Age_s(moment);
    behind_rad += effect->Behind_rad(moment);
  }
  AngleMoment read = moment;
  read.read_rad = moment.shaft_rad + behind_rad + (age_s != 0.0 ? course_.Beside_rad(moment, age_s) : 0.0);
  double device_rad = read.read_rad + MountingOf_rad(moment.setup);
  course_.ReadEarlier(age_s, read);
  for (const auto& effect : effects_) device_rad += effect->ShaftError_rad(read);
  return device_rad;
}

double EncoderTwin::DeviceError_rad(const AngleMoment& moment, double device_rad) const {
  const DeviceSettings& device = EncoderOf(scenario_).device;
  double error_rad = graduation_.Error_rad(device_rad);
  for (const auto& effect : effects_) error_rad += effect->DeviceError_rad(moment, device_rad);
  const double phase_rad = device.signal_periods * (device_rad - signal_zero_rad_);
  return error_rad + mechanics::SignalError_rad(signals_, phase_rad) / device.signal_periods;
}

double EncoderTwin::ReferenceError_rad(const AngleMoment& moment) const {
  double error_rad = 0.0;
  for (const auto& effect : effects_) error_rad += effect->ReferenceError_rad(moment);
  return error_rad;
}

double EncoderTwin::Shown_rad(const AngleMoment& moment) const {
  const double device_rad = ShaftAngle_rad(moment);
  return device_rad + DeviceError_rad(moment, device_rad) + empirical_.At(moment.reading, ToSeconds(moment.now));
}

double EncoderTwin::DeviceAt_rad(const Reading& reading, double shaft_rad, double gains_rad_s2) {
  AngleMoment moment =
      MomentOf(reading, run_up_rad_, reading.temperature_degC - scenario_.environment.reference_degC);
  // A reference that errs by arcseconds an arcminute: each step leaves a hundredth of what is wrong, or less.
  constexpr int kSteps = 5;
  for (int k = 0; k < kSteps; ++k) {
    const double stands_rad = reading.reference_rad - ReferenceError_rad(moment);
    if (stands_rad == moment.shaft_rad) break;
    moment.shaft_rad = stands_rad;
  }
  moment.shaft_rad += shaft_rad;
  moment.gains_rad_s2 = gains_rad_s2;
  Advance(moment);
  return Shown_rad(moment);
}

double EncoderTwin::AboveReference_K(Time now) {
  return room_ ? room_->AboveReference_K(now) : 0.0;
}

/// By the bench's thermometer.
void EncoderTwin::LogTemperature(Reading& reading) {
  if (!room_) return;
  reading.temperature_degC = room_->Temperature_degC(reading.time);
  if (scenario_.noise_free) return;
  Stream stream(scenario_.RunSeed(), "environment.sensor");
  stream.Seek(static_cast<std::uint64_t>(reading.reading));
  reading.temperature_degC += scenario_.environment.sensor_noise_K * stream.Normal();
}

/// When the line that the reading names passes the head: the shaft then stands where the scale shows its angle.
void EncoderTwin::TakeStamp(Reading& reading) {
  const Time now(FromSeconds(spindle_.Now_s()));
  AngleMoment moment = MomentOf(reading, 0.0, AboveReference_K(now));
  moment.now = now;
  const double mounting_rad = MountingOf_rad(reading.setup);
  constexpr int kSteps = 3;  // of a curve that falls by a thousandth and less
  for (int k = 0; k < kSteps; ++k) {
    const double device_rad = moment.shaft_rad + mounting_rad;
    moment.shaft_rad += reading.reference_rad - device_rad - DeviceError_rad(moment, device_rad);
  }
  double stamp_s = spindle_.PassesAt_s(reading.pass, moment.shaft_rad, reading.velocity_rad_s);
  if (!scenario_.noise_free) {
    Stream stream(scenario_.RunSeed(), "stamp.noise");
    stream.Seek(static_cast<std::uint64_t>(reading.reading));
    stamp_s += EncoderOf(scenario_).device.stamp_noise_s * stream.Normal();
  }
  reading.time = Time(FromSeconds(stamp_s));
  Quantity{"stamp_s"}(reading) = stamp_s;
}

void EncoderTwin::Take(Reading& reading) {
  if (EncoderOf(scenario_).encoder_procedure.kind == "coast") {
    TakeStamp(reading);
    return LogTemperature(reading);
  }
  LogTemperature(reading);
  const AngleMoment moment = MomentOf(reading, run_up_rad_, AboveReference_K(reading.time));
  Advance(moment);
  reading.reference_rad += ReferenceError_rad(moment);
  reading.measured_rad = Shown_rad(moment);
  if (scenario_.noise_free) return;
  reading.reference_rad += ReferenceNoise(scenario_, reading.reading);
  reading.measured_rad = ReadDevice_rad(scenario_, reading.reading, reading.measured_rad);
}

nlohmann::json EncoderTwin::Truth() const {
  // At one instant: what does not follow the angle is the same everywhere then and goes with the mean.
  return {{"device", CurveOf([&](double angle_rad) { return DeviceError_rad({}, angle_rad); })},
          {"reference", CurveOf([&](double angle_rad) {
             AngleMoment moment;
             moment.shaft_rad = angle_rad;
             return ReferenceError_rad(moment);
           })},
          {"effects", ToJson(scenario_.effects)},
          {"seed", scenario_.seed}};
}

}  // namespace twinbench::sim
