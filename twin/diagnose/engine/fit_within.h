#pragma once

#include <Eigen/Core>
#include <functional>

namespace twinbench::diagnose {

/// What a model leaves of the data at x; false where it cannot say. Both have their size already.
using Residuals = std::function<bool(const Eigen::VectorXd& x, Eigen::Ref<Eigen::VectorXd> left)>;

struct Bounds {
  Eigen::VectorXd lower, upper;
};

struct FitSteps {
  int most = 12;                // iterations
  double relative_size = 1e-6;  // of central differences
  bool is_central = true;  // differences, as exact as sizes that are stated ask for; else one residual a parameter
};

/// Where the sum of squares is least within the bounds (Levenberg-Marquardt by Ceres, slopes by central differences); the start
/// where no fit is usable.
/// @param rows  Number of residuals.
Eigen::VectorXd FitWithin(const Residuals& residuals, Eigen::Index rows, const Eigen::VectorXd& start, const Bounds& bounds,
                          const FitSteps& steps = {});

}  // namespace twinbench::diagnose
