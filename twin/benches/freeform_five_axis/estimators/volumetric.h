#pragma once

#include <Eigen/Core>

namespace twinbench::benches::freeform::estimators {

/// What is left of vectors at points when the rigid motion that fits them best (small, six parameters) is taken
/// out: the errors of two models may differ by it without saying anything else.
/// @param points, vectors  3 x count.
Eigen::Matrix3Xd WithoutRigidMotion(const Eigen::Matrix3Xd& points, const Eigen::Matrix3Xd& vectors);

}  // namespace twinbench::benches::freeform::estimators
