#include "twin/diagnose/encoder/signals.h"

#include <algorithm>
#include <cmath>

#include "twin/core/errors.h"

namespace twinbench::diagnose::encoder {
namespace {

double Sign(double value) {
  return value > 0.0 ? 1.0 : value < 0.0 ? -1.0 : 0.0;
}

double Wrapped(double angle_rad) {
  return std::remainder(angle_rad, 2.0 * units::kPi);
}

double Value(const EffectSettings& effect, const char* parameter) {
  const auto found = effect.parameters.find(parameter);
  Require(found != effect.parameters.end(), "an effect lacks a parameter of the catalogue");
  return found->second;
}

Eigen::VectorXd Harmonic_rad(const EffectSettings& effect, const Eigen::VectorXd& angle_rad, double order) {
  return Value(effect, "amplitude") * (order * angle_rad.array() + Value(effect, "phase")).cos();
}

/// Angle of the point (cosine + offset, (1 + ratio) sine with a lead + offset) against the phase.
Eigen::VectorXd SignalFault_rad(const EffectSettings& effect, const SignalContext& context) {
  const Eigen::VectorXd phase = SignalPhase_rad(context);
  const double periods = context.device.signal_periods;
  if (effect.name == "signal_clipping") return ClippingError_rad(phase, Value(effect, "level")) / periods;
  const auto of = [&](const char* name, const char* parameter) {
    return effect.name == name ? Value(effect, parameter) : 0.0;
  };
  const double ratio = of("amplitude_mismatch", "ratio"), lead_rad = of("quadrature_error", "angle");
  const double offset_sin = of("signal_offset", "offset_sin"), offset_cos = of("signal_offset", "offset_cos");
  return phase.unaryExpr([&](double p) {
    const double y = (1.0 + ratio) * std::sin(p + lead_rad) + offset_sin, x = std::cos(p) + offset_cos;
    return Wrapped(std::atan2(y, x) - p) / periods;
  });
}

/// Play of half a width either way, dragged along the straight way from reading to reading.
Eigen::VectorXd PlaySignal_rad(const SignalContext& context, double width_rad) {
  const double half_rad = 0.5 * std::abs(width_rad), run_up_rad = RunUp_rad(context);
  double follower_rad = context.reference_rad[0] - half_rad;
  Eigen::VectorXd signal_rad(context.Readings());
  for (Eigen::Index i = 0; i < signal_rad.size(); ++i) {
    const double shaft_rad = context.reference_rad[i];
    for (const double way_rad : {shaft_rad - context.direction[i] * run_up_rad, shaft_rad})
      follower_rad = std::clamp(follower_rad, way_rad - half_rad, way_rad + half_rad);
    signal_rad[i] = Sign(width_rad) * (follower_rad - shaft_rad);
  }
  return signal_rad;
}

}  // namespace

SignalContext ContextOf(const Schedule& s, const Eigen::VectorXd& device_rad, const DeviceSettings& device) {
  SignalContext context;
  context.reading = s.reading;
  context.setup = s.setup;
  context.pass = s.pass;
  context.direction = s.direction;
  context.since_start_s = s.time_s;
  context.time_s = s.time_s.array() - s.time_s[0];
  context.reference_rad = s.reference_rad;
  context.device_rad = device_rad;
  context.velocity_rad_s = s.velocity_rad_s.array().isFinite().select(s.velocity_rad_s, 0.0);
  context.device = device;
  return context;
}

Eigen::MatrixXd Wave(const Eigen::VectorXd& phase_rad) {
  Eigen::MatrixXd wave(phase_rad.size(), 2);
  wave << phase_rad.array().cos().matrix(), phase_rad.array().sin().matrix();
  return wave;
}

Eigen::VectorXd SignalPhase_rad(const SignalContext& context) {
  return context.device.signal_periods * (context.device_rad.array() - context.device.signal_zero_rad);
}

Eigen::VectorXd Sense(const SignalContext& context, bool holds_at_rest) {
  const auto& d = context.direction;
  const auto moving = std::find_if(d.begin(), d.end(), [](int direction) { return direction != 0; });
  double last = moving == d.end() ? 0.0 : *moving;
  Eigen::VectorXd sense(context.Readings());
  for (Eigen::Index i = 0; i < sense.size(); ++i) {
    if (d[i] != 0) last = d[i];
    sense[i] = d[i] != 0 || holds_at_rest ? last : 0.0;
  }
  return sense;
}

std::vector<Eigen::VectorXd> Senses(const SignalContext& context) {
  Eigen::VectorXd way = Eigen::VectorXd::Constant(context.Readings(), context.direction[0]);
  for (Eigen::Index i = 1; i < way.size(); ++i) {
    const double step_rad = context.reference_rad[i] - context.reference_rad[i - 1];
    way[i] = std::abs(step_rad) > units::urad ? Sign(step_rad) : way[i - 1];
  }
  std::vector<Eigen::VectorXd> senses = {Sense(context, true)};
  for (const Eigen::VectorXd& other : {Sense(context, false), way}) {
    if (std::find(senses.begin(), senses.end(), other) == senses.end()) senses.push_back(other);
  }
  return senses;
}

Eigen::VectorXd TravelSinceReversal_rad(const SignalContext& context) {
  Eigen::VectorXd travel_rad = Eigen::VectorXd::Zero(context.Readings());
  const Eigen::VectorXd sense = Sense(context, true);
  for (Eigen::Index i = 1; i < travel_rad.size(); ++i) {
    const double way_rad = std::abs(context.reference_rad[i] - context.reference_rad[i - 1]);
    const bool onwards = sense[i] == sense[i - 1] && context.pass[i] == context.pass[i - 1];
    travel_rad[i] = onwards ? travel_rad[i - 1] + way_rad : context.Moves() ? way_rad : 0.0;
  }
  return travel_rad;
}

double RunUp_rad(const SignalContext& context) {
  if (context.Moves() || context.Readings() < 2) return 0.0;
  std::vector<double> steps_rad;
  for (Eigen::Index i = 1; i < context.Readings(); ++i)
    steps_rad.push_back(std::abs(context.reference_rad[i] - context.reference_rad[i - 1]));
  std::nth_element(steps_rad.begin(), steps_rad.begin() + std::ssize(steps_rad) / 2, steps_rad.end());
  return 0.5 * steps_rad[steps_rad.size() / 2];
}

Eigen::MatrixXd Relaxation(const SignalContext& context, double settles_over_rad, double run_up_rad) {
  double at_rad = context.reference_rad[0] - context.direction[0] * run_up_rad, state = 0.0, first = 1.0;
  const auto travel_to = [&](double to_rad) {
    const double sense = Sign(to_rad - at_rad), left = std::exp(-std::abs(to_rad - at_rad) / settles_over_rad);
    state = sense == 0.0 ? state : sense + (state - sense) * left;
    first *= left;
    at_rad = to_rad;
  };
  Eigen::MatrixXd states(context.Readings(), 2);
  for (Eigen::Index i = 0; i < states.rows(); ++i) {
    travel_to(context.reference_rad[i] - context.direction[i] * run_up_rad);
    travel_to(context.reference_rad[i]);
    states.row(i) << state, first;
  }
  return states;
}

Eigen::VectorXd ClippingError_rad(const Eigen::VectorXd& phase_rad, double level) {
  return phase_rad.unaryExpr([level](double p) {
    const double y = std::clamp(std::sin(p), -level, level), x = std::clamp(std::cos(p), -level, level);
    return Wrapped(std::atan2(y, x) - p);
  });
}

Eigen::MatrixXd DriftSignals_s(const SignalContext& context) {
  const auto t = context.since_start_s.array();
  Eigen::MatrixXd signals(t.size(), 2);
  signals << t.matrix(), (t * (1.0 - t / units::hour)).matrix();
  return signals;
}

Eigen::VectorXd StepSignal(const SignalContext& context, int at_reading) {
  Eigen::VectorXd step(context.Readings());
  for (Eigen::Index i = 0; i < step.size(); ++i) step[i] = context.reading[i] < at_reading ? 0.0 : 1.0;
  return step;
}

Eigen::VectorXd EffectSignal_rad(const EffectSettings& e, const SignalContext& c) {
  const auto& name = e.name;
  if (name == "eccentricity") return Harmonic_rad(e, c.device_rad, 1.0);
  if (name == "ellipticity") return Harmonic_rad(e, c.device_rad, 2.0);
  if (name == "periodic") return Harmonic_rad(e, c.device_rad, Value(e, "order"));
  if (name == "gear_mesh") return Harmonic_rad(e, c.device_rad, Value(e, "teeth"));
  if (name == "interpolation") return Harmonic_rad(e, c.device_rad, Value(e, "order") * c.device.lines);
  if (name == "reference_fault") return -Harmonic_rad(e, c.reference_rad, Value(e, "order"));
  if (name == "latency") return -Value(e, "delay") * c.velocity_rad_s;
  if (name == "backlash") return PlaySignal_rad(c, Value(e, "width"));
  if (name == "hysteresis") return -Value(e, "lag") * Relaxation(c, Value(e, "settles_over"), RunUp_rad(c)).col(0);
  if (name == "scale") return Value(e, "ratio") * c.reference_rad;
  if (name == "drift") return Value(e, "rate") * DriftSignals_s(c) * Eigen::Vector2d(1.0, Value(e, "curvature"));
  if (name == "slip") return Value(e, "step") * StepSignal(c, static_cast<int>(Value(e, "at_reading")));
  if (name == "outliers") return Eigen::VectorXd::Zero(c.Readings());
  return SignalFault_rad(e, c);
}

}  // namespace twinbench::diagnose::encoder
