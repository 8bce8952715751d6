#pragma once

#include <Eigen/Core>
#include <vector>

#include "twin/benches/freeform_five_axis/estimators/identification.h"
#include "twin/core/estimator.h"

namespace twinbench::benches::freeform::estimators {

/// What is left of vectors at points when the rigid motion that fits them best (small, six parameters) is taken
/// out: the errors of two models may differ by it without saying anything else.
/// @param points, vectors  3 x count.
Eigen::Matrix3Xd WithoutRigidMotion(const Eigen::Matrix3Xd& points, const Eigen::Matrix3Xd& vectors);
/// The same of many sets of vectors, each a column: 3 count x sets.
Eigen::MatrixXd ColumnsWithoutRigidMotion(const Eigen::Matrix3Xd& points, const Eigen::MatrixXd& vectors);

/// Poses that a run had not, anywhere where it had been; the same for every run of the same range.
std::vector<PoseRead> UnseenPoses(const std::vector<PoseRead>& seen, const FreeformSettings& bench, int count);

/// Places of a regular grid over where a run has been, in X, Y and Z, at one pair of A and B.
struct Grid {
  double a_rad = 0.0, b_rad = 0.0;
  std::vector<PoseRead> poses;  // Z runs fastest
};

inline constexpr int kGridNodes = 5;  // an axis

/// One grid at A = B = 0, and three half-way to where A, B, and both of them had been.
std::vector<Grid> GridsOf(const std::vector<PoseRead>& seen, const FreeformSettings& bench, int nodes_an_axis);

/// All poses of some grids, one grid after the other.
std::vector<PoseRead> PosesOnGrids(const std::vector<Grid>& grids);

/// The tip in the X slide's frame as the estimator's own equations have it [um]: 3 x poses.
Eigen::Matrix3Xd Tips_um(const FreeformSettings& bench, const std::vector<PoseRead>& poses,
                         const Eigen::VectorXd& unknowns, Estimator estimator);

/// Volumetric error at poses, best rigid motion taken out [um]: 3 x poses.
struct VolumetricErrors {
  Eigen::Matrix3Xd nominal_um, error_um, u_um;
  /// Square root of the covariance of all components, pose by pose: cov = R R^T. As many columns as the machine has
  /// unknowns.
  Eigen::MatrixXd root_um = {};
};

/// Uncertainty: noise of the readings, first order. Not included: what the readings leave open.
VolumetricErrors PredictErrors(const FreeformSettings& bench, const std::vector<PoseRead>& poses,
                               const Identification& found, Estimator estimator);
/// The same without their uncertainties, which take most of the time.
VolumetricErrors PredictErrorsAlone(const FreeformSettings& bench, const std::vector<PoseRead>& poses,
                               const Identification& found, Estimator estimator);

}  // namespace twinbench::benches::freeform::estimators
