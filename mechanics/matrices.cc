#include "mechanics/matrices.h"

#include <Eigen/LU>
#include <unsupported/Eigen/MatrixFunctions>

namespace twinbench::mechanics {

Eigen::MatrixXd ExponentialOf(const Eigen::MatrixXd& a) {
  return a.exp();
}

Eigen::MatrixXd InverseOf(const Eigen::MatrixXd& a) {
  return a.inverse();
}

double LargestEigenvalueOf(const Eigen::MatrixXd& a) {
  Eigen::MatrixXd power = a / a.norm();  // squared again and again, it keeps the largest alone
  for (int k = 0; k < 30; ++k, power /= power.norm()) power = power * power;
  return a.cwiseProduct(power).sum() / power.trace();
}

}  // namespace twinbench::mechanics
