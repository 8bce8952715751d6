#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "twin/benches/circular_motion/settings.h"
#include "twin/core/reading.h"

/// Circles as the estimators see them: what each reading shows of the machine's and the instruments' errors.
/// Written apart from the twin, so that each can find the other's mistakes.
namespace twinbench::separate::circular {

/// One reading with a value.
struct CirclePoint {
  int setup = 0, pass = 0, direction = 1;
  bool is_bar = true, has_angle = true;  // of a bar without an encoder the radius is all
  bool is_drive = false;                 // read as a grid is, but nothing is mounted that could be turned
  double commanded_rad = kNaN, radius_m = kNaN;
  double rate_rad_s = 0.0;  // of the commanded angle; 0: at rest
  double feed_m_s = 0.0;
  double above_K = 0.0;                         // temperature above that of reference
  double radial_m = kNaN, tangential_m = kNaN;  // shown, from the commanded point
  double u_radial_m = kNaN, u_tangential_m = kNaN;  // NaN: not shown
  Eigen::Vector2d of_machine{0.0, 0.0}, of_steps{0.0, 0.0};  // shares of both variances

  Eigen::Vector2d Commanded_m() const {
    return {radius_m * std::cos(commanded_rad), radius_m * std::sin(commanded_rad)};
  }
  /// What was shown; 0 and no weight where nothing was.
  Eigen::Vector2d Values_m() const { return {radial_m, has_angle ? tangential_m : 0.0}; }
  Eigen::Vector2d Weights() const { return {1.0 / u_radial_m, has_angle ? 1.0 / u_tangential_m : 0.0}; }
};

/// The readings with a radius, by the scenario's stated noise.
std::vector<CirclePoint> PointsOf(const std::vector<Reading>& readings, const Scenario& scenario);

/// What is unknown of machine and instruments. Waves are cosine and sine. A mismatch is x less y, half of it each: what a
/// radius shows of two axes of which it does not show what they have in common, but for the square of the mean lag: by half of
/// that times the rate's square circles are smaller.
struct CircleErrors {
  AxisPair lag_s{}, scale{}, bow_m{}, s_shape_m{}, backlash_m{}, spike_m{};
  AxisPair cyclic_sine_m{}, cyclic_cosine_m{}, expansion_per_K{}, drift_m_per_K{};
  double squareness_rad = 0.0, lag_mismatch_s = 0.0, scale_mismatch = 0.0;
  double lag_mean_square_s2 = 0.0;
  double lag_mean_s = 0.0;  // no unknown: its root
  double bar_gain = 0.0, bar_cubic_per_m2 = 0.0, bar_expansion_per_K = 0.0;
  AxisPair ball2_m{}, ball3_m{}, eccentricity_rad{}, ellipticity_rad{};
  double encoder_latency_s = 0.0;
};

/// What a scenario states and no reading is asked for. The grid is the standard: as it was calibrated.
struct CircleConstants {
  double span_m, pitch_m, spike_time_s, height_m;
  double bar_latency_s = 0.0;
  AxisPair tilt_rad{};    // of the encoder's axis
  AxisPair grid_scale{};  // shows too much in proportion
  double grid_shear_rad = 0.0, grid_sde_m = 0.0, grid_period_m = 1.0;
  CircleErrors bar = {};  // gain and form of its balls: a radius alone would take them for the machine's
  bool is_delay = false;  // an axis is late by a fixed time, and does not answer 1 / (1 + lag s)
};
CircleConstants ConstantsOf(const CircularSettings& settings);

/// What is unknown of every set-up.
struct CircleMounting {
  AxisPair offset_m{};        // of the commanded centre, as bar or grid sees it
  double rotation_rad = 0.0;  // zero of the encoder, or rotation of the grid
  double length_m = 0.0;      // of the bar
};

/// What a function of some numbers came to last. Slopes are differenced over one unknown at a time, and most unknowns leave most of
/// the model as it is.
template <class Value, std::size_t kInputs>
class LastValue {
 public:
  template <class Make>
  const Value& At(const std::array<double, kInputs>& inputs, const Make& make) {
    if (is_empty_ || inputs != inputs_) value_ = make();
    is_empty_ = false;
    inputs_ = inputs;
    return value_;
  }

 private:
  std::array<double, kInputs> inputs_{};
  Value value_{};
  bool is_empty_ = true;
};

/// One axis at an instant: where it is, which way it goes, and how far it has come since it turned round.
struct AxisMotion {
  double at_m, sense, since_turn_m, since_turn_s;
  double wave_sine = 0.0, wave_cosine = 1.0;  // of its place in the screw's pitch
  double spike_times = 0.0, spike_decay = 0.0;  // since it turned, in times of the spike, and e^(1 - that)
};

/// Cosine and sine of the angles by which the encoder's axis is tilted.
struct TiltTurns {
  double cx, sx, cy, sy;
};

/// Cosine and sine of an angle.
struct Turn {
  double cosine = 1.0, sine = 0.0;

  Turn() = default;
  explicit Turn(double angle_rad) : cosine(std::cos(angle_rad)), sine(std::sin(angle_rad)) {}
};

/// What was computed last of one point.
struct CircleMemo {
  using Axes = std::array<LastValue<AxisMotion, 3>, 2>;
  Axes when_bar_is_read, when_encoder_is_read;
  LastValue<double, 5> ball_form_m, scale_error_rad;
  LastValue<TiltTurns, 2> tilt;
  LastValue<Turn, 1> of_grid, back;
};

/// Radial and tangential deviation that would be shown [m].
/// @param memo  Of this point and these constants.
Eigen::Vector2d Shown_m(const CirclePoint& point, const CircleErrors& errors, const CircleMounting& mounting,
                        const CircleConstants& known, CircleMemo& memo);
Eigen::Vector2d Shown_m(const CirclePoint& point, const CircleErrors& errors, const CircleMounting& mounting,
                        const CircleConstants& known);

/// The other way: deviation of the spindle from the commanded point, x and y [m], from what was shown.
Eigen::Vector2d Deviation_m(const CirclePoint& point, const CircleErrors& errors, const CircleMounting& mounting,
                            const CircleConstants& known);

/// One unknown of CircleErrors.
struct CircleUnknown {
  std::string key;  // of the scenario: "machine.scale_x_um_m"; of a wave with _cosine or _sine for its azimuth
  std::string unit;
  double to_SI;
  double step;  // SI, over which slopes are differenced
  double& (*in)(CircleErrors&);
  /// kRadiusOnly: stands for those that need an angle where there is none; kRadiusAtFeeds: at several, else a length takes it up. kBarShown: its slope is in proportion to what the
  /// bar shows, and nothing before the set-ups are known. Of a bar: one with an encoder.
  enum class Needs { kNothing, kAngle, kRadiusOnly, kRadiusAtFeeds, kTemperature, kBar, kBarShown, kBarAndTemperature } needs;
};
const std::vector<CircleUnknown>& CircleUnknowns();

}  // namespace twinbench::separate::circular
