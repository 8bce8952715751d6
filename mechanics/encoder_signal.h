#pragma once

#include <cstdint>
#include <limits>

/// Sine and cosine of a reading head, their faults, and what an interpolator makes of them.
namespace twinbench::mechanics {

/// The device's sine and cosine before they are turned into an angle:
/// clip((1 + ratio) sin(p + quadrature) + offset_sin), clip(cos p + offset_cos), with phase p.
struct SignalState {
  double offset_sin = 0.0, offset_cos = 0.0;  // share of the amplitude
  double ratio = 0.0;                         // sine over cosine, - 1
  double quadrature_rad = 0.0;
  double clip_level = std::numeric_limits<double>::infinity();  // share of the amplitude
};

/// Angle that the signals of `state` give at phase `phase_rad`, minus that phase; within half a period.
double SignalError_rad(const SignalState& state, double phase_rad);

/// Phase at which the signals of `state` give `shown_rad`: the inverse of phase + SignalError_rad, within half a
/// period of `shown_rad`. Where clipping holds the signals still over a range of phases, its beginning.
double PhaseShowing_rad(const SignalState& state, double shown_rad);

/// One incremental output: the interpolator divides each line of the scale into `factor` steps and gives a square
/// wave of one period a step, high in the first half of it. Step 0 begins at the zero of the scale.
///
/// The output falls in the middle of a step on the way up and, as the same edges are then passed the other way, at
/// its beginning on the way down: half a step of difference between the directions belongs to every counter that
/// is triggered by falling edges.
///
/// Angles are angles of the scale [rad], unwrapped: RingEncoder::Shaft_rad gives those of the shaft.
class InterpolatedSignal {
 public:
  /// @throws std::invalid_argument unless lines and factor are positive, the point (cosine, sine) surely goes round
  ///         the origin (ratio above -1, quadrature below a quarter period, the offsets together below 0.7 of the
  ///         smaller amplitude times cos quadrature), and the clip level is above both offsets.
  InterpolatedSignal(const SignalState& state, int lines, int factor);

  /// Angle that the signals show, before it is cut into steps.
  double Shown_rad(double scale_rad) const;

  /// Whole steps that a counter has counted at this angle: those begun since zero.
  std::int64_t Steps(double scale_rad) const;
  double Step_rad() const;

  /// Where the output falls in step `step` in motion upwards (direction +1) or downwards (-1).
  double FallingEdge_rad(std::int64_t step, int direction) const;

  /// Number of the step whose falling edge comes first after `scale_rad` in motion of this direction.
  std::int64_t NextFallingStep(double scale_rad, int direction) const;

  int steps_per_turn() const { return lines_ * factor_; }

 private:
  SignalState state_;
  int lines_;
  int factor_;
};

}  // namespace twinbench::mechanics
