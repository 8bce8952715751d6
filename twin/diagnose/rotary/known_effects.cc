#include "twin/diagnose/rotary/known_effects.h"

#include <algorithm>
#include <cmath>

#include "twin/core/errors.h"
#include "twin/core/reading.h"
#include "twin/core/units.h"
#include "twin/diagnose/rotary/signals.h"
#include "twin/model/signals.h"

namespace twinbench::diagnose::rotary {
namespace {

int ChannelIndex(const std::string& name) {
  const auto found = std::find(kChannelNames.begin(), kChannelNames.end(), name);
  return found == kChannelNames.end() ? -1 : static_cast<int>(found - kChannelNames.begin());
}

double Value(const Parameters& parameters, const char* name) {
  const auto found = parameters.find(name);
  Require(found != parameters.end(), "an effect lacks a parameter of the catalogue");
  return found->second;
}

/// Tilt of the target's body that goes round with the signal's phase.
Eigen::MatrixXd Whirl(const Eigen::VectorXd& angle, const Whirling& whirling, const SignalContext& context) {
  const Eigen::Vector4d ex = context.shown_by_motion.col(1) - whirling.lever_m * context.shown_by_motion.col(3);
  const Eigen::Vector4d ey = whirling.sense * context.shown_by_motion.col(2);
  const Eigen::VectorXd cosine = angle.array().cos() * InCircle(context.run.schedule).array();
  const Eigen::VectorXd sine = angle.array().sin() * InCircle(context.run.schedule).array();
  Eigen::MatrixXd rows(angle.size() * kChannels, 2);
  rows.col(0) = OnChannels(cosine, ex) + OnChannels(sine, ey);
  rows.col(1) = OnChannels(-sine, ex) + OnChannels(cosine, ey);
  return rows;
}

Eigen::Vector4d ToneWeight(const std::string& where) {
  if (where == "all") return Eigen::Vector4d::Ones();
  if (where == "yaw") return {1.0, 0.0, 1.0, 0.0};
  if (where == "tilt") return {0.0, 1.0, 0.0, 1.0};
  return Eigen::Vector4d::Unit(ChannelIndex(where));
}

Eigen::VectorXd AmplitudesOf(const EffectSettings& e) {
  const auto value = [&e](const char* name) { return Value(e.parameters, name); };
  if (e.name == "laser_drift") return Eigen::VectorXd::Constant(1, value("drift"));
  if (e.name == "mount_creep" || e.name == "settling") return Eigen::VectorXd::Constant(1, value("amplitude"));
  if (e.name == "thermal_tilt") return Eigen::VectorXd::Constant(1, value("tilt_per_kelvin"));
  if (e.name == "backlash") return Eigen::VectorXd::Constant(1, value("half_width"));
  if (e.name == "slip") return Eigen::VectorXd::Constant(1, value(e.where == "lateral" ? "shift" : "angle"));
  if (e.name == "mode_hop") return Eigen::VectorXd::Constant(1, value("wavelength_step"));
  if (e.name == "adc_step") return Eigen::VectorXd::Constant(1, value("step"));
  if (e.name == "crosstalk") return Eigen::VectorXd::Constant(1, value("fraction"));
  if (e.name == "bearing_half_frequency") return Eigen::Vector2d(value("tilt"), 0.0);
  if (e.name == "tone")
    return value("amplitude") * Eigen::Vector2d(std::sin(value("phase")), std::cos(value("phase")));
  return {};
}

}  // namespace

Eigen::VectorXd CrosstalkRows(int channel, const SignalContext& context) {
  Eigen::VectorXd rows = Eigen::VectorXd::Zero(context.run.Rows());
  const int before = context.scanned_before[static_cast<std::size_t>(channel)];
  for (Eigen::Index k = 0; k < rows.size(); k += kChannels) rows[k + channel] = context.shown_m[k + before];
  return rows;
}

Eigen::MatrixXd AdcStepSignal(int channel, double at_V, double blur_V, const SignalContext& context) {
  const double sensitivity_V_m = context.sensitivity_V_m[static_cast<std::size_t>(channel / 2)];
  const double width_V = std::sqrt(2.0) * blur_V;
  Eigen::VectorXd rows = Eigen::VectorXd::Zero(context.run.Rows());
  for (Eigen::Index k = channel; k < rows.size(); k += kChannels) {
    rows[k] = 0.5 * std::erfc((at_V - context.shown_m[k] * sensitivity_V_m) / width_V) / sensitivity_V_m;
  }
  return rows;
}

Eigen::MatrixXd HalfFrequencySignal(double order, const Whirling& whirling, const SignalContext& context) {
  const Schedule& s = context.run.schedule;
  return Whirl(order * ContinuedTarget_rad(s, whirling.through_setups), whirling, context);
}

bool AltersBench(const std::string& effect) {
  static const std::vector<std::string> names = {
      "psd_gain",          "psd_roll",      "psd_nonlinearity",       "stray_light",     "psd_distance",
      "wavelength_offset", "grating_pitch", "wavelength_temperature", "incidence_offset"};
  return std::find(names.begin(), names.end(), effect) != names.end();
}

void AlterBench(const std::string& effect, const std::string& where, const Parameters& parameters, double above_K,
                OpticalBench& bench) {
  const std::size_t psd = where.starts_with("psd_b") ? 1 : 0;
  if (effect == "psd_gain")
    bench.gain_error[static_cast<std::size_t>(ChannelIndex(where))] += Value(parameters, "gain_error");
  if (effect == "psd_roll") bench.roll_rad[psd] += Value(parameters, "roll");
  if (effect == "psd_nonlinearity") bench.cubic_per_m2[psd] += Value(parameters, "cubic");
  if (effect == "stray_light") bench.stray_fraction[psd] += Value(parameters, "fraction");
  if (effect == "psd_distance") bench.distance_error_m[psd] += Value(parameters, "distance_error");
  if (effect == "wavelength_offset") bench.wavelength_error_m += Value(parameters, "wavelength_error");
  // The grating equation knows the product of wavelength and grooves a length only.
  if (effect == "grating_pitch")
    bench.wavelength_error_m -= bench.nominal.wavelength_m * (1.0 - 1.0 / (1.0 + Value(parameters, "pitch_error")));
  if (effect == "wavelength_temperature")
    bench.wavelength_error_m += Value(parameters, "wavelength_per_kelvin") * above_K;
  if (effect == "incidence_offset") bench.incidence_rad += Value(parameters, "incidence");
}

OpticalBench WithKnownEffects(OpticalBench bench, const Scenario& scenario, double above_K) {
  bench.wavelength_error_m += scenario.laser.wavelength_per_kelvin_m * above_K;
  for (const EffectSettings& e : scenario.effects) AlterBench(e.name, e.where, e.parameters, above_K, bench);
  return bench;
}

Eigen::Vector4d WeightOf(const std::string& where, const Eigen::Matrix4d& shown_by_motion) {
  if (where == "yaw") return shown_by_motion.col(0);
  if (where == "tilt") return shown_by_motion.col(1);
  if (where == "roll") return shown_by_motion.col(2);
  if (where == "lateral") return shown_by_motion.col(3);
  if (where == "psd_a") return {1.0, 1.0, 0.0, 0.0};
  if (where == "psd_b") return {0.0, 0.0, 1.0, 1.0};
  return Eigen::Vector4d::Unit(ChannelIndex(where));
}

Eigen::MatrixXd EffectSignal(const std::string& effect, const std::string& where, const Parameters& shape,
                             const SignalContext& context) {
  const Schedule& s = context.run.schedule;
  const auto moved = [&](const Eigen::VectorXd& signal) {
    return OnChannels(signal, WeightOf(where, context.shown_by_motion));
  };
  if (effect == "laser_drift") {
    return OnChannels(model::Drift_s(s.time_s) * Eigen::Vector2d(1.0, Value(shape, "curvature")),
                      context.shown_by_laser.col(where == "yaw" ? 0 : 1));
  }
  if (effect == "mount_creep") return moved((model::SinceFirst_s(s) / Value(shape, "time_constant")).array().log1p().matrix());
  if (effect == "thermal_tilt") return moved(model::Lagged(s.time_s, model::Above_K(s, context.reference_degC), Value(shape, "lag")));
  if (effect == "mode_hop")
    return OnChannels(model::Step(s.reading, std::floor(Value(shape, "at_reading"))), context.shown_by_wavelength);
  if (effect == "slip") return moved(model::Step(s.reading, std::floor(Value(shape, "at_reading"))));
  // A rotor that lags stays behind on the side it came from; the reference turns against the target.
  const double side = where == "reference" ? 1.0 : -1.0;
  const Eigen::Vector4d yaw = context.shown_by_motion.col(0);
  if (effect == "backlash") return OnChannels(side * DirectionSignal(s), yaw);
  if (effect == "settling")
    return OnChannels(-SettlingSignal(s, context.settle_s, Value(shape, "time_constant")), yaw);
  if (effect == "bearing_half_frequency") {
    return HalfFrequencySignal(Value(shape, "order"), {false, context.target_height_m, 1.0}, context);
  }
  if (effect == "tone") return OnChannels(model::Tone(s.time_s, Value(shape, "frequency")), ToneWeight(where));
  if (effect == "adc_step") {
    return AdcStepSignal(ChannelIndex(where), Value(shape, "at_voltage"), std::max(context.sample_noise_V, 1e-6),
                         context);
  }
  if (effect == "crosstalk") return CrosstalkRows(ChannelIndex(where), context);
  Require(false, "an effect without a signal was asked for one");
  return {};
}

Eigen::VectorXd KnownSignal(const Scenario& scenario, const SignalContext& context) {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(context.run.Rows());
  for (const EffectSettings& e : scenario.effects) {
    const Eigen::VectorXd amplitudes = AmplitudesOf(e);
    if (amplitudes.size() > 0) sum += EffectSignal(e.name, e.where, e.parameters, context) * amplitudes;
  }
  return sum;
}

}  // namespace twinbench::diagnose::rotary
