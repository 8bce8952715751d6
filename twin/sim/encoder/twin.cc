#include "twin/sim/encoder/twin.h"

#include <cmath>

#include "twin/core/stream.h"
#include "twin/sim/truth.h"

namespace twinbench::sim {
namespace {

/// A stop is approached in its direction over half the way from its neighbour.
double Approach_rad(const Reading& reading, const EncoderProcedureSettings& procedure) {
  if (procedure.kind != "stops") return 0.0;
  return reading.direction * units::kPi / procedure.stops;
}

double Clip(double value, double level) {
  return std::clamp(value, -level, level);
}

double Noise(const Scenario& scenario, int reading) {
  Stream stream(scenario.seed, "device.noise");
  stream.Seek(static_cast<std::uint64_t>(reading));
  return scenario.device.noise_rad * stream.Normal();
}

double Quantised(double angle_rad, double step_rad) {
  return step_rad > 0.0 ? step_rad * std::round(angle_rad / step_rad) : angle_rad;
}

}  // namespace

double SignalError_rad(const SignalState& state, double phase_rad) {
  const double sine = (1.0 + state.ratio) * std::sin(phase_rad + state.quadrature_rad) + state.offset_sin;
  const double cosine = std::cos(phase_rad) + state.offset_cos;
  const double shown_rad = std::atan2(Clip(sine, state.clip_level), Clip(cosine, state.clip_level));
  return std::remainder(shown_rad - phase_rad, 2.0 * units::kPi);
}

EncoderTwin::EncoderTwin(const Scenario& scenario) : scenario_(scenario) {
  for (const EffectSettings& effect : scenario.effects) effects_.push_back(MakeAngleEffect(effect, scenario));
  for (const auto& effect : effects_) effect->AlterSignals(signals_);
  for (const EmpiricalSettings& signal : scenario.empiricals) {
    for (std::size_t i = 0; i < signal.reading.size(); ++i)
      empirical_rad_[signal.reading[i]] += signal.value_rad[i];
  }
}

double EncoderTwin::DeviceAngle_rad(const AngleMoment& moment) {
  const DeviceSettings& device = scenario_.device;
  double device_rad = moment.shaft_rad + scenario_.encoder_procedure.mounting_rad[moment.setup];
  for (const auto& effect : effects_) device_rad += effect->ShaftError_rad(moment);
  double error_rad = 0.0;
  for (const auto& effect : effects_) error_rad += effect->DeviceError_rad(moment, device_rad);
  const double phase_rad = device.signal_periods * (device_rad - device.signal_zero_rad);
  return device_rad + error_rad + SignalError_rad(signals_, phase_rad) / device.signal_periods;
}

double EncoderTwin::Empirical_rad(int reading) const {
  const auto found = empirical_rad_.find(reading);
  return found == empirical_rad_.end() ? 0.0 : found->second;
}

void EncoderTwin::Take(Reading& reading) {
  const AngleMoment moment{reading.time,           reading.setup,
                           reading.reading,        reading.reference_rad,
                           reading.velocity_rad_s, Approach_rad(reading, scenario_.encoder_procedure)};
  for (const auto& effect : effects_) effect->Advance(moment);
  for (const auto& effect : effects_) reading.reference_rad += effect->ReferenceError_rad(moment);
  reading.measured_rad = DeviceAngle_rad(moment) + Empirical_rad(reading.reading);
  if (scenario_.noise_free) return;
  reading.measured_rad =
      Quantised(reading.measured_rad + Noise(scenario_, reading.reading), scenario_.device.resolution_rad);
}

nlohmann::json EncoderTwin::Truth() const {
  nlohmann::json json = {{"effects", nlohmann::json::array()}, {"seed", scenario_.seed}};
  for (const EffectSettings& effect : scenario_.effects) json["effects"].push_back(ToJson(effect));
  return json;
}

}  // namespace twinbench::sim
