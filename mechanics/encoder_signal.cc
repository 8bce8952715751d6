#include "mechanics/encoder_signal.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mechanics/require.h"

namespace twinbench::mechanics {
namespace {

constexpr double kPi = std::numbers::pi;

double Clip(double value, double level) {
  return std::clamp(value, -level, level);
}

void CheckState(const SignalState& s) {
  Require(s.ratio > -1.0 && std::isfinite(s.ratio), "signal: ratio must be above -1");
  Require(std::abs(s.quadrature_rad) < 0.5 * kPi, "signal: quadrature_rad must be below a quarter period");
  // The ellipse comes no nearer to its centre than this.
  const double smaller = std::min(1.0, 1.0 + s.ratio) * std::cos(s.quadrature_rad) / std::numbers::sqrt2;
  Require(std::hypot(s.offset_sin, s.offset_cos) < smaller, "signal: offsets must be below the amplitudes");
  Require(s.clip_level > std::max(std::abs(s.offset_sin), std::abs(s.offset_cos)),
          "signal: clip_level must be above the offsets");
}

/// Without clipping: shown at p is the angle of the point (cos p + offset_cos, (1 + ratio) sin(p + quadrature) +
/// offset_sin), so that its part across the direction `shown` vanishes: a sin p + b cos p = c.
double UnclippedPhaseShowing_rad(const SignalState& s, double shown_rad) {
  const double sine = std::sin(shown_rad);
  const double cosine = std::cos(shown_rad);
  const double a = (1.0 + s.ratio) * std::cos(s.quadrature_rad) * cosine;
  const double b = (1.0 + s.ratio) * std::sin(s.quadrature_rad) * cosine - sine;
  const double c = s.offset_cos * sine - s.offset_sin * cosine;
  const double phase_rad = std::asin(Clip(c / std::hypot(a, b), 1.0)) - std::atan2(b, a);
  return shown_rad + std::remainder(phase_rad - shown_rad, 2.0 * kPi);
}

bool Clips(const SignalState& s, double phase_rad) {
  const double sine = (1.0 + s.ratio) * std::sin(phase_rad + s.quadrature_rad) + s.offset_sin;
  const double cosine = std::cos(phase_rad) + s.offset_cos;
  return std::max(std::abs(sine), std::abs(cosine)) > s.clip_level;
}

/// The shown angle never falls with the phase, clipped or not: halves the period around it.
double ClippedPhaseShowing_rad(const SignalState& s, double shown_rad) {
  double below_rad = shown_rad - kPi;
  double above_rad = shown_rad + kPi;
  for (int i = 0; i < 60; ++i) {
    const double middle_rad = 0.5 * (below_rad + above_rad);
    const bool reached = middle_rad + SignalError_rad(s, middle_rad) >= shown_rad;
    (reached ? above_rad : below_rad) = middle_rad;
  }
  return above_rad;
}

}  // namespace

double SignalError_rad(const SignalState& state, double phase_rad) {
  const double sine = (1.0 + state.ratio) * std::sin(phase_rad + state.quadrature_rad) + state.offset_sin;
  const double cosine = std::cos(phase_rad) + state.offset_cos;
  const double shown_rad = std::atan2(Clip(sine, state.clip_level), Clip(cosine, state.clip_level));
  return std::remainder(shown_rad - phase_rad, 2.0 * kPi);
}

double PhaseShowing_rad(const SignalState& state, double shown_rad) {
  const double phase_rad = UnclippedPhaseShowing_rad(state, shown_rad);
  return Clips(state, phase_rad) ? ClippedPhaseShowing_rad(state, shown_rad) : phase_rad;
}

InterpolatedSignal::InterpolatedSignal(const SignalState& state, int lines, int factor)
    : state_((CheckState(state), state)), lines_(lines), factor_(factor) {
  Require(lines > 0, "signal: lines must be positive");
  Require(factor > 0, "signal: the interpolation factor must be positive");
}

double InterpolatedSignal::Shown_rad(double scale_rad) const {
  return scale_rad + SignalError_rad(state_, lines_ * scale_rad) / lines_;
}

double InterpolatedSignal::Step_rad() const {
  return 2.0 * kPi / steps_per_turn();
}

std::int64_t InterpolatedSignal::Steps(double scale_rad) const {
  return static_cast<std::int64_t>(std::floor(Shown_rad(scale_rad) / Step_rad()));
}

double InterpolatedSignal::FallingEdge_rad(std::int64_t step, int direction) const {
  const double steps = static_cast<double>(step) + (direction > 0 ? 0.5 : 0.0);
  return PhaseShowing_rad(state_, 2.0 * kPi * steps / factor_) / lines_;
}

std::int64_t InterpolatedSignal::NextFallingStep(double scale_rad, int direction) const {
  const int way = direction > 0 ? 1 : -1;
  const double steps = Shown_rad(scale_rad) / Step_rad() - (way > 0 ? 0.5 : 0.0);
  auto step = static_cast<std::int64_t>(way > 0 ? std::ceil(steps) : std::floor(steps));
  while (way * (FallingEdge_rad(step, way) - scale_rad) <= 0.0) step += way;
  while (way * (FallingEdge_rad(step - way, way) - scale_rad) > 0.0) step -= way;
  return step;
}

}  // namespace twinbench::mechanics
