#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>
#include <vector>

#include "mechanics/periodic_spline.h"
#include "mechanics/pose_error.h"

/// How the six errors of a rotary table depend on its angle.
namespace twinbench::mechanics {

/// amplitude cos(order angle + phase), added to one component (0..5 as in PoseError). The order need not be an
/// integer and then counts the unwrapped angle.
struct Harmonic {
  int component = 0;
  double order = 1.0;
  double amplitude = 0.0;  // rad or m
  double phase_rad = 0.0;
};

/// Values at given angles, periodic over one turn. Angles in any order, modulo a turn, no two alike. A component
/// is either empty (no such error) or has one value an angle.
struct ErrorTable {
  std::vector<double> angle_rad;
  std::array<std::vector<double>, kErrorComponents> value;
};

/// Whirl of the rotor on its lubricating film or balls: tilt and radial motion that turn with about half the
/// rotor's speed, so that two turns differ (ISO 230-7 calls it asynchronous).
struct HalfFrequencyMotion {
  double order = 0.5;  // of the unwrapped angle
  double tilt_rad = 0.0;
  double radial_m = 0.0;
};

/// Sum of harmonics, a table and the half-frequency motion. Immutable: one instance may serve many threads.
class ErrorMotion {
 public:
  ErrorMotion() = default;

  /// @throws std::invalid_argument for a component outside 0..5, a number that is not finite, or a table with
  ///         equal angles or columns of the wrong length.
  explicit ErrorMotion(const std::vector<Harmonic>& harmonics, const ErrorTable& table = {},
                       const HalfFrequencyMotion& half = {});

  /// The errors at an unwrapped angle, in the frame in which harmonics and table were given. Between the angles of
  /// the table a periodic cubic spline is used, at them its value is exact to rounding.
  PoseError Evaluate(double unwrapped_rad) const;

 private:
  using Vector6 = Eigen::Matrix<double, kErrorComponents, 1>;
  /// All harmonics of one order: cosine and sine coefficient of each component.
  struct Line {
    double order = 0.0;
    bool next = false;  // order is the one before plus one: its phasor follows by one complex product
    Vector6 cosine = Vector6::Zero();
    Vector6 sine = Vector6::Zero();
  };

  void Add(const Harmonic& harmonic);
  Vector6 SumLines(double unwrapped_rad) const;

  std::vector<Line> lines_;  // by rising order
  PeriodicSpline spline_;
};

/// Random smooth errors: orders 1..`orders`, each with a random phase and an amplitude that falls as 1/order,
/// scaled so that every component has exactly `rms` over a full turn.
///
/// @param rms     Of each component [rad, m]; zero leaves it out, but draws its numbers all the same, so that one
///                component can be switched off without changing the others.
/// @param normal  Gives independent standard normal numbers; called 2 x 6 x orders times.
std::vector<Harmonic> MakeRandomHarmonics(const std::array<double, kErrorComponents>& rms, int orders,
                                          const std::function<double()>& normal);

}  // namespace twinbench::mechanics
