#pragma once

#include <Eigen/Core>
#include <vector>

#include "twin/diagnose/screen/sample.h"

namespace twinbench::diagnose::screen {

/// Alternatives to be tried on every channel: orders, frequencies, onsets. Item e has `width` columns (2 for cosine
/// and sine), each with a free amplitude in each channel.
struct Scan {
  std::vector<Eigen::MatrixXd> shapes;  // readings x (items * width): one for all channels, or one a channel
  int width = 1;

  int Items() const { return static_cast<int>(shapes.front().cols()) / width; }
  const Eigen::MatrixXd& ShapesOf(int channel) const {
    return shapes[shapes.size() == 1 ? 0 : static_cast<std::size_t>(channel)];
  }
};

/// Least squares of one item in the run, in the space that the free unknowns leave. Amplitude k of channel c stands
/// at c * width + k, in SI of the reading per unit of the shape.
struct Fit {
  int width = 1;
  Eigen::MatrixXd information;  // S' W S, whitened
  Eigen::VectorXd before;       // diagonal of S' S: before projection
  Eigen::VectorXd gradient;     // S' W y

  double chi2 = 0.0;  // what the item explains
  int dof = 0;        // directions that survive the projection
  Eigen::VectorXd amplitude;
  Eigen::MatrixXd cov;

  /// The fit with amplitudes restricted to `constraint` times fewer ones.
  Fit Constrained(const Eigen::MatrixXd& constraint, int new_width) const;
};

/// Fits item `item` to the run itself.
Fit FitItem(const Sample& sample, const Scan& scan, int item);

/// Standard normal deviate as improbable as chi2 of `dof` degrees of freedom (Wilson and Hilferty 1931).
double NormalScore(double chi2, int dof);

/// Normal score of what each item explains in each column: items x columns. An item of
/// which the free unknowns leave less than 1e-3 in every direction scores -infinity.
Eigen::MatrixXd Scores(const Sample& sample, const Scan& scan);

}  // namespace twinbench::diagnose::screen
