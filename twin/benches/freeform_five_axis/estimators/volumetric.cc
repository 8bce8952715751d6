#include "twin/benches/freeform_five_axis/estimators/volumetric.h"

#include "twin/core/linear_algebra.h"

namespace twinbench::benches::freeform::estimators {

Eigen::Matrix3Xd WithoutRigidMotion(const Eigen::Matrix3Xd& points, const Eigen::Matrix3Xd& vectors) {
  const Eigen::Vector3d middle = points.rowwise().mean();
  Eigen::MatrixXd motion(3 * points.cols(), 6);
  for (Eigen::Index k = 0; k < points.cols(); ++k) {
    const Eigen::Vector3d p = points.col(k) - middle;
    Eigen::Matrix3d turned;  // p x e of each axis, negative: a turn moves p by turn x p
    turned << 0.0, p.z(), -p.y(), -p.z(), 0.0, p.x(), p.y(), -p.x(), 0.0;
    motion.middleRows(3 * k, 3) << Eigen::Matrix3d::Identity(), turned;
  }
  constexpr double kRank = 1e-12;
  const Eigen::VectorXd flat = vectors.reshaped();
  const Eigen::VectorXd left = flat - motion * SolveRanked(motion, flat, kRank).x;
  return left.reshaped(3, points.cols());
}

}  // namespace twinbench::benches::freeform::estimators
