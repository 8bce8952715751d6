#include "twin/benches/rotary_4dof/estimators/published.h"
#include "twin/core/linear_algebra.h"

namespace twinbench::separate {
namespace {

Eigen::MatrixXd RightHandSide(const Eigen::MatrixXd& test_1, const Eigen::MatrixXd& test_2) {
  const Eigen::Index n = test_1.rows();
  Eigen::MatrixXd right = Eigen::MatrixXd::Zero(2 * n, test_1.cols());
  right.topRows(n) = test_1;
  right.middleRows(n, n - 1) = test_2.topRows(n - 1);
  return right;
}

}  // namespace

Eigen::MatrixXd PublishedMatrix(int n) {
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(2 * n, 2 * n);
  for (int i = 0; i < n; ++i) {
    A(i, i) = A(i, n + i) = 1.0;
    if (i < n - 1) A(n + i, i) = A(n + i, n + i + 1) = 1.0;
  }
  A.row(2 * n - 1).tail(n).setOnes();
  return A;
}

Eigen::MatrixXd SolvePublished(const Eigen::MatrixXd& test_1, const Eigen::MatrixXd& test_2) {
  return SolveSquare(PublishedMatrix(static_cast<int>(test_1.rows())), RightHandSide(test_1, test_2));
}

}  // namespace twinbench::separate
