#include "twin/benches/circular_motion/twin/machine.h"

#include <algorithm>
#include <cmath>

namespace twinbench::sim {
namespace {

/// One axis on its way: A cos(phase).
struct LaggedAxis {
  double amplitude_m, phase_rad;
  int direction;
  double rate_rad_s;

  double At_m() const { return amplitude_m * std::cos(phase_rad); }
  /// Of the phase since the last reversal; that was at a whole number of half turns.
  double SinceReversal_rad() const {
    const double ahead_rad = direction * phase_rad;
    return ahead_rad - units::kPi * std::floor(ahead_rad / units::kPi);
  }
  /// Sign of its velocity since then.
  double Sense() const {
    return std::fmod(std::floor(direction * phase_rad / units::kPi), 2.0) == 0.0 ? -1.0 : 1.0;
  }
  double SinceReversal_m() const { return amplitude_m * (1.0 - std::cos(SinceReversal_rad())); }
};

LaggedAxis AxisOf(const CircularMachineSettings& m, const CircleInstant& at, std::size_t axis) {
  const double rate_rad_s = at.Rate_rad_s(), lag = rate_rad_s * m.lag_s[axis];
  const double quarter_rad = axis == 0 ? 0.0 : 0.5 * units::kPi;
  if (m.lag_kind == "fixed_delay") return {at.radius_m, at.commanded_rad - quarter_rad - lag, at.direction, rate_rad_s};
  return {at.radius_m / std::hypot(1.0, lag), at.commanded_rad - quarter_rad - std::atan(lag), at.direction,
          rate_rad_s};
}

double Backlash_m(double width_m, const LaggedAxis& axis) {
  const double taken_up_m = std::min(axis.SinceReversal_m(), std::abs(width_m));
  return axis.Sense() * (0.5 * width_m - std::copysign(taken_up_m, width_m));
}

/// It sticks, then comes loose: f exp(1 - f) of the time since the reversal.
double Spike_m(double height_m, double time_s, const LaggedAxis& axis) {
  if (axis.rate_rad_s == 0.0) return 0.0;
  const double f = axis.SinceReversal_rad() / std::abs(axis.rate_rad_s) / time_s;
  return -axis.Sense() * height_m * f * std::exp(1.0 - f);
}

double Straightness_m(double bow_m, double s_shape_m, double share) {
  const double square = share * share;
  return bow_m * 0.5 * (3.0 * square - 1.0) + s_shape_m * 0.5 * (5.0 * square - 3.0) * share;
}

/// What follows from the place alone, of axis k.
double PlaceError_m(const CircularMachineSettings& m, double above_K, std::size_t k, double own_m, double other_m) {
  return (m.scale[k] + m.expansion_per_K[k] * above_K) * own_m + m.drift_m_per_K[k] * above_K +
         Straightness_m(m.bow_m[k], m.s_shape_m[k], other_m / m.span_m);
}

}  // namespace

CircleInstant CircleInstant::Before(double latency_s) const {
  CircleInstant before = *this;
  before.commanded_rad -= Rate_rad_s() * latency_s;
  return before;
}

CircleMachine::CircleMachine(const CircularMachineSettings& settings) : settings_(settings) {
  for (std::size_t k = 0; k < 2; ++k) {
    if (settings.cyclic_m[k] != 0.0)
      Add(CyclicError{k, settings.cyclic_m[k], settings.cyclic_phase_rad[k], settings.cyclic_pitch_m});
    if (settings.spike_m[k] != 0.0) Add(ReversalSpike{k, settings.spike_m[k], settings.spike_time_s});
  }
}

Eigen::Vector2d CircleMachine::Position_m(const CircleInstant& at) const {
  return Position_m(at, {AxisOf(settings_, at, 0).At_m(), AxisOf(settings_, at, 1).At_m()});
}

Eigen::Vector2d CircleMachine::Position_m(const CircleInstant& at, const Eigen::Vector2d& lagged_m) const {
  const std::array<LaggedAxis, 2> axes = {AxisOf(settings_, at, 0), AxisOf(settings_, at, 1)};
  Eigen::Vector2d p_m = lagged_m;
  for (std::size_t k = 0; k < 2; ++k) {
    const auto row = static_cast<Eigen::Index>(k);
    p_m[row] += PlaceError_m(settings_, at.above_K, k, lagged_m[row], lagged_m[1 - row]) +
                Backlash_m(settings_.backlash_m[k], axes[k]);
  }
  p_m.x() -= settings_.squareness_rad * lagged_m.y();
  for (const CyclicError& c : cyclic_) {
    const auto row = static_cast<Eigen::Index>(c.axis);
    p_m[row] += c.amplitude_m * std::sin(units::turn * lagged_m[row] / c.pitch_m + c.phase_rad);
  }
  for (const ReversalSpike& spike : spikes_)
    p_m[static_cast<Eigen::Index>(spike.axis)] += Spike_m(spike.height_m, spike.time_s, axes[spike.axis]);
  return p_m;
}

}  // namespace twinbench::sim
