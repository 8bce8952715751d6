#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "twin/separate/series.h"

namespace twinbench::separate::encoder {

/// Where readings were taken, and what a fit leaves of them.
struct FitRest {
  std::vector<Eigen::VectorXd> th_rad = {}, rest_rad = {};
  int visible = 0;                // the highest order that the angles tell from those below
  std::vector<int> of_lines = {};  // orders that are known to be possible: lines, teeth, signals
  double white_rad2 = 0.0;         // variance of a reading about the fit
  double noise_dof = 0.0;          // behind the covariances of the fitted orders
  double step_rad = 0.0;           // of what is read, which rounds every visit of a place alike
};

/// Orders above the highest of a fit. What is left shows those up to `visible`. Readings at few angles show others folded
/// into the fitted ones, and no reading says how large they are: their amplitude is taken to fall as 1 / order from what
/// the upper half of the visible ones shows; an order of lines may be all of the order that it looks like.
struct Unresolved {
  int visible = 0;
  double seen_rad2 = 0.0;   // variance at any angle of orders above the highest that what is left shows
  double level_rad2 = 0.0;  // (order x amplitude)^2 of those beyond; 0: the upper half does not stand out of the noise
  std::vector<std::pair<int, double>> lines = {};  // order, its amplitude's square
  std::vector<int> hidden = {};                    // orders of lines that are the same at all angles

  double Variance_rad2() const;  // of all of them at any angle
  /// A column for every independent part of those that are not seen, one standard deviation large, at these angles.
  Eigen::MatrixXd Waves(const Eigen::VectorXd& th_rad) const;
};

/// The median of the upper half counts: a single order that stands out is no sign of more. Where the last quarter has fallen
/// below it, the spectrum has come to its end, and no more counts than that quarter may have.
Unresolved UnresolvedBy(const harmonics::HarmonicSeries& series, const FitRest& rest);

}  // namespace twinbench::separate::encoder
