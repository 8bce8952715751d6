#pragma once

/// The angle encoder that a table's controller reads.
namespace twinbench::mechanics {

/// Subdivision (interpolation) error repeats with every period of the graduation and, being inside the loop, makes
/// the rotor stand wrong by itself; a resolution leaves it free within half a step.
struct ScaleParameters {
  double resolution_rad = 0.0;   // 0: none
  double subdivision_rad = 0.0;  // amplitude
  double subdivision_phase_rad = 0.0;
  int periods = 36000;  // of the graduation, a turn

  bool active() const { return resolution_rad > 0.0 || subdivision_rad != 0.0; }
};

/// What the scale shows before it is cut into steps: a + subdivision sin(periods a + phase).
double Interpolated_rad(const ScaleParameters& scale, double angle_rad);

/// What the controller is told: the nearest step.
double Shown_rad(const ScaleParameters& scale, double angle_rad);

/// Where the scale stands when it shows `shown_rad` before it is cut into steps. The error must be smaller than
/// what would turn the scale back: |subdivision| periods < 1.
double AngleShowing_rad(const ScaleParameters& scale, double shown_rad);

/// @throws std::invalid_argument unless resolution and periods make sense and AngleShowing_rad exists.
void Check(const ScaleParameters& scale);

}  // namespace twinbench::mechanics
