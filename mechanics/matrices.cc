#include "mechanics/matrices.h"

#include <Eigen/Eigenvalues>
#include <unsupported/Eigen/MatrixFunctions>

namespace twinbench::mechanics {

Eigen::MatrixXd ExponentialOf(const Eigen::MatrixXd& a) {
  return a.exp();
}

Eigen::VectorXd EigenvaluesOfSymmetric(const Eigen::MatrixXd& a) {
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(a, Eigen::EigenvaluesOnly).eigenvalues();
}

}  // namespace twinbench::mechanics
