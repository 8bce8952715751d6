#pragma once

#include <Eigen/Core>
#include <array>
#include <map>
#include <vector>

#include "twin/benches/rotary_4dof/estimators/chain.h"
#include "twin/benches/rotary_4dof/estimators/geometry.h"
#include "twin/benches/rotary_4dof/estimators/motion.h"

namespace twinbench::separate {

using measure::BenchGeometry;
using measure::Matrix4;
using measure::Motion;

/// How the grating was brought back to the PSDs after the reference had been turned by the shift.
enum class Clamping {
  kReclamp,  // the grating was clamped anew on the reference's rotor
  kReseat    // the reference's body was turned back on the target's rotor
};

/// One set-up. rho is the lab azimuth of the reference's rotor, the same at every stop.
struct SetUp {
  int label = 0;  // Reading::setup
  int shift = 0;  // (target index + reference index) mod n
  double rho_rad = kNaN;
  Clamping clamping = Clamping::kReseat;
};

/// The nine series of unknowns, n values each, in this order in every block of this room.
enum class Series { kTargetEx, kTargetEy, kTargetEz, kTargetDy, kRefEx, kRefEy, kRefEz, kRefDx, kRefDy };
inline constexpr int kSeries = 9;
inline constexpr int kTargetSeries = 4;
inline constexpr int kMountUnknowns = 4;  // per set-up: constants of ez, ex, ey, dy
inline constexpr int kSeatUnknowns =
    4;  // per reseat set-up: tilt x, y and eccentricity x, y of the reference's body

/// Lengths inside the fits are in this unit, so that they stand beside radians without hurting the conditioning.
inline constexpr double kLengthUnit_m = 0.1;

/// Which set-ups there are, on which grid, with which levers: all that the linear model needs to know.
struct Design {
  int n = 0;                       // positions of a full circle, at least 3
  double target_offset_rad = 0.0;  // own angle of position 0, in [0, 2 pi / n)
  double reference_offset_rad = 0.0;
  std::vector<SetUp> setups;
  double target_height_m = kNaN;     // laser spot above the target table's origin (0.130)
  double reference_height_m = kNaN;  // and above the reference's (0.050)

  double Step_rad() const;
  double TargetAngle_rad(int position) const { return target_offset_rad + position * Step_rad(); }
  double ReferenceAngle_rad(int position) const { return reference_offset_rad + position * Step_rad(); }
  int ReferencePosition(const SetUp& setup, int target) const { return ((setup.shift - target) % n + n) % n; }

  int Unknowns() const;
  int Column(Series series, int position) const;
  int MountColumn(int setup) const;  // first of four
  int SeatColumn(int setup) const;   // first of four; only for reseat set-ups
  Stop StopAt(const SetUp& setup, int target) const;
};

/// First-order model of one stop: motion = sum over its columns of d * unknown, lengths in kLengthUnit_m.
///   wobble  ex + j ey = a_T + e^{j rho} c_R + e^{j phi} seat + mount
///   index   ez        = ez_T + ez_R + mount
///   radial  dy        = dy_T - h_T ex_T + Im(e^{j rho} (dx_R + j dy_R)) - h_R Re(e^{j rho} c_R) + seat + mount
struct StopModel {
  static constexpr int kMost = kSeries + kMountUnknowns + kSeatUnknowns;
  int columns = 0;
  std::array<int, kMost> column{};
  Eigen::Matrix<double, measure::kDofs, kMost> d = Eigen::Matrix<double, measure::kDofs, kMost>::Zero();
};
StopModel ModelStop(const Design& design, int setup, int target);

/// Coefficients of the nine series in the four motions; the same at every stop of a set-up.
Eigen::Matrix<double, measure::kDofs, kSeries> SeriesCoefficients(const Design& design, const SetUp& setup);

/// Coefficients of the four seat unknowns at target angle phi.
Matrix4 SeatCoefficients(const Design& design, double target_rad);

/// The measured full circles on their grid.
struct Sample {
  std::size_t motion = 0;  // index into the motions
  int setup = 0;           // index into Design::setups
  int target = 0;
  int reference = 0;
};
struct Layout {
  Design design;
  std::vector<Sample> samples;  // usable motions only (full circle, status ok)
};

/// How to read the commanded angles.
struct LayoutOptions {
  int positions = 0;                          // 0: count the distinct target positions
  Clamping clamping = Clamping::kReseat;      // of all set-ups ...
  std::map<int, Clamping> clamping_of_setup;  // ... but these, by Reading::setup
};

/// Finds grid and set-ups in the commanded angles.
/// @throws InputError if the angles are not on an evenly spaced grid (to a thousandth of a step), if target +
///         reference is not constant in a set-up, or if there is no usable full-circle motion.
Layout FindLayout(const std::vector<Motion>& motions, const BenchGeometry& geometry, const LayoutOptions& options);

}  // namespace twinbench::separate
