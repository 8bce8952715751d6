#pragma once

#include <string>

#include "twin/benches/circular_motion/estimators/circle_model.h"

/// The vector form: every unknown of machine, instruments and set-ups in one least-squares fit of radius and angle, or of the
/// radius alone where a bar without an encoder measured.
namespace twinbench::separate::circular {

/// A variance, and what of it the instruments' quanta make, and what does not repeat: the machine's stated noise, and whatever is left over beyond all
/// that is stated. The rest is noise of the instruments.
struct PartedVariance {
  double all = 0.0, of_steps = 0.0, of_machine = 0.0;

  PartedVariance operator+(const PartedVariance& other) const {
    return {all + other.all, of_steps + other.of_steps, of_machine + other.of_machine};
  }
  PartedVariance operator*(double factor) const { return {factor * all, factor * of_steps, factor * of_machine}; }
};

/// What results share: the unknowns behind them.
struct SharedUncertainty {
  Eigen::MatrixXd cov = {};      // SI; empty: nothing was fitted
  Eigen::MatrixXd hidden = {};   // directions that the readings do not show, as columns, SI
  Eigen::VectorXd typical = {};  // of each unknown: what the readings would just show of it alone, SI
  // Of `cov`, what the stated noise of the machine and the instruments' quanta make:
  Eigen::MatrixXd of_machine = {}, of_steps = {};
  double excess = 0.0;  // of it, what is left over beyond the stated noise: a share, the same everywhere

  bool IsKnown() const { return cov.size() > 0; }
  /// Of a result with these slopes; NaN if it goes with something that the readings do not show.
  double Variance(const Eigen::VectorXd& slope) const;
  /// The same by source, and without a look at what the readings do not show.
  PartedVariance Parted(const Eigen::VectorXd& slope) const;
};

struct CircleFit {
  std::vector<std::size_t> fitted;  // of CircleUnknowns, in the order of `shared`
  std::vector<int> setups;          // in the order of `mountings`; four unknowns each, behind those
  CircleErrors errors;              // what was not fitted is 0
  std::vector<CircleMounting> mountings;
  SharedUncertainty shared;
  std::vector<bool> identified;            // one an unknown, those of the set-ups too
  std::vector<std::string> not_separable;  // in words
  Eigen::Index dof = 0;
  double chi = kNaN;  // what is left over, in stated uncertainties, rms
  double rms_bar_m = kNaN, rms_encoder_rad = kNaN, rms_grid_m = kNaN;

  const CircleMounting& MountingOf(int setup) const;
  Eigen::Index UnknownOf(int setup) const;  // the first of its four
};

/// As many points at even steps, or a few less.
std::vector<CirclePoint> Thinned(const std::vector<CirclePoint>& points, std::size_t enough);

/// Gauss-Newton. Along directions that the readings do not show the solution is the one with the least errors of the instruments,
/// then of the machine; they are named. Thermal unknowns are left out unless the temperature changed by 0.2 K.
///
/// Uncertainty: stated noise, larger if more is left over, and by how far that goes on from reading to reading. Not included: calibration of the grid; an error of
/// machine or instruments that is none of the unknowns; what is not separable.
/// @throws InputError if there are fewer values than unknowns.
CircleFit FitCircles(const std::vector<CirclePoint>& points, const CircleConstants& known);

/// Slope of Shown_m and Deviation_m with respect to every unknown of the fit: 2 x unknowns.
Eigen::Matrix2Xd SlopeOfShown(const CirclePoint& point, const CircleFit& fit, const CircleConstants& known);
Eigen::Matrix2Xd SlopeOfDeviation(const CirclePoint& point, const CircleFit& fit, const CircleConstants& known);

}  // namespace twinbench::separate::circular
