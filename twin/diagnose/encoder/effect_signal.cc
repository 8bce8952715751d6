#include <algorithm>
#include <cmath>

#include "twin/core/errors.h"
#include "twin/core/units.h"
#include "twin/diagnose/encoder/signals.h"
#include "twin/model/signals.h"

namespace twinbench::diagnose::encoder {
namespace {

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
    return std::remainder(std::atan2(y, x) - p, 2.0 * units::kPi) / periods;
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
    signal_rad[i] = std::copysign(1.0, width_rad) * (follower_rad - shaft_rad);
  }
  return signal_rad;
}

}  // namespace

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
  if (name == "drift") return Value(e, "rate") * model::Drift_s(c.since_start_s) * Eigen::Vector2d(1.0, Value(e, "curvature"));
  if (name == "slip") return Value(e, "step") * model::Step(c.reading, std::floor(Value(e, "at_reading")));
  if (name == "outliers") return Eigen::VectorXd::Zero(c.Readings());
  return SignalFault_rad(e, c);
}

}  // namespace twinbench::diagnose::encoder
