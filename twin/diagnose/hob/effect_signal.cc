#include <cmath>

#include "twin/core/errors.h"
#include "twin/core/units.h"
#include "twin/diagnose/hob/known_signals.h"
#include "twin/model/signals.h"

namespace twinbench::diagnose::hob {
namespace {

double Value(const EffectSettings& effect, const char* parameter) {
  const auto found = effect.parameters.find(parameter);
  Require(found != effect.parameters.end(), "an effect lacks a parameter of the catalogue");
  return found->second;
}

bool IsOf(const EffectSettings& effect, std::initializer_list<const char*> names) {
  for (const char* name : names) {
    if (effect.name == name) return true;
  }
  return false;
}

Eigen::VectorXd Harmonic_rad(const EffectSettings& effect, const Eigen::VectorXd& angle_rad, double order) {
  return Value(effect, "amplitude") * (order * angle_rad.array() + Value(effect, "phase")).cos();
}

/// Error of the hob's encoder, exact: angle of the point (cosine + offset, (1 + ratio) sine with a lead + offset)
/// against the phase.
Eigen::VectorXd SignalFault_rad(const EffectSettings& effect, const SignalContext& c) {
  const auto of = [&](const char* name, const char* parameter) {
    return effect.name == name ? Value(effect, parameter) : 0.0;
  };
  const double ratio = of("amplitude_mismatch", "ratio"), lead_rad = of("quadrature_error", "angle");
  const double offset_sin = of("signal_offset", "offset_sin"), offset_cos = of("signal_offset", "offset_cos");
  return HobSignalPhase_rad(c).unaryExpr([&](double p) {
    const double y = (1.0 + ratio) * std::sin(p + lead_rad) + offset_sin, x = std::cos(p) + offset_cos;
    return std::remainder(std::atan2(y, x) - p, 2.0 * units::kPi) / c.hob_lines;
  });
}

/// What an encoder shows too much.
Eigen::VectorXd OfEncoder_rad(const EffectSettings& e, const SignalContext& c) {
  const Eigen::VectorXd& angle_rad = e.where == "hob" ? c.hob_rad : c.ring_rad;
  if (e.name == "eccentricity") return Harmonic_rad(e, angle_rad, 1.0);
  if (e.name == "ellipticity") return Harmonic_rad(e, angle_rad, 2.0);
  if (e.name == "periodic") return Harmonic_rad(e, angle_rad, Value(e, "order"));
  if (e.name == "slip") return Value(e, "step") * model::Step(c.schedule.reading, std::floor(Value(e, "at_reading")));
  return SignalFault_rad(e, c);
}

/// What the table does against the hob.
Eigen::VectorXd OfMotion_rad(const EffectSettings& e, const SignalContext& c) {
  if (e.name == "hob_runout") return Harmonic_rad(e, c.hob_rad, 1.0);
  if (e.name == "worm") return Harmonic_rad(e, c.table_rad, c.train.WormOrder());
  if (e.name == "gear_mesh") return Harmonic_rad(e, c.hob_rad, c.train.hob_starts);
  if (e.name == "backlash") return -0.5 * Value(e, "width") * c.direction;
  if (e.name == "hysteresis") return -Value(e, "lag") * Relaxation(c, Value(e, "settles_over"), c.ramp_s);
  if (e.name == "drift") return Value(e, "rate") * model::Drift_s(c.schedule.time_s) * Eigen::Vector2d(1.0, Value(e, "curvature"));
  if (e.name == "tone") return Harmonic_rad(e, 2.0 * units::kPi * c.schedule.time_s, Value(e, "frequency"));
  Require(e.name == "outliers", "an effect of the catalogue has no signal");
  return Eigen::VectorXd::Zero(c.Samples());
}

}  // namespace

SampleSignal EffectSignal(const EffectSettings& e, const SignalContext& c) {
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(c.Samples());
  if (e.name == "latency") return {-Value(e, "delay") * c.velocity_rad_s, none};
  const bool of_hob = e.where == "hob" || IsOf(e, {"signal_offset", "amplitude_mismatch", "quadrature_error"});
  if (of_hob) return {-c.train.Ratio() * OfEncoder_rad(e, c), none};
  if (e.where == "table") return {OfEncoder_rad(e, c), none};
  const Eigen::VectorXd motion_rad = OfMotion_rad(e, c);
  return {motion_rad, motion_rad};
}

}  // namespace twinbench::diagnose::hob
