#include "twin/diagnose/engine/projector.h"

#include <gtest/gtest.h>

#include <Eigen/QR>

#include "tests/diagnose/support/synthetic_run.h"

namespace twinbench::diagnose {
namespace {

constexpr int kBlocks = 7, kSize = 2, kCore = 9, kRows = 120;

/// Every row touches one local block and the whole core; two core columns are equal, so only the prior parts them.
Nuisance ArrowNuisance() {
  const Eigen::MatrixXd values = RandomMatrix("jacobian", kRows, kSize + kCore);
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(kRows, kBlocks * kSize + kCore);
  for (int k = 0; k < kRows; ++k) {
    dense.row(k).segment((k % kBlocks) * kSize, kSize) = values.row(k).head(kSize);
    dense.row(k).tail(kCore) = values.row(k).tail(kCore);
  }
  dense.rightCols(1) = dense.middleCols(kBlocks * kSize, 1);
  Nuisance nuisance;
  nuisance.jacobian = dense.sparseView();
  nuisance.prior_precision = Eigen::VectorXd::Constant(dense.cols(), 1e-4);
  nuisance.blocks = kBlocks;
  nuisance.block_size = kSize;
  return nuisance;
}

/// The same by an orthogonal factorisation of the data with the priors as extra rows.
Eigen::MatrixXd ApplyDense(const Nuisance& nuisance, const Eigen::MatrixXd& Y) {
  const Eigen::MatrixXd J = nuisance.jacobian;
  Eigen::MatrixXd stacked(J.rows() + J.cols(), J.cols());
  stacked << J, Eigen::MatrixXd(nuisance.prior_precision.cwiseSqrt().asDiagonal());
  Eigen::MatrixXd data = Eigen::MatrixXd::Zero(stacked.rows(), Y.cols());
  data.topRows(Y.rows()) = Y;
  return Y - J * stacked.householderQr().solve(data);
}

TEST(Projector, AgreesWithAnOrthogonalFactorisationOfAllUnknowns) {
  const Nuisance nuisance = ArrowNuisance();
  const Projector projector(nuisance.jacobian, nuisance);
  const Eigen::MatrixXd Y = RandomMatrix("data", kRows, 5);
  EXPECT_LT((projector.Apply(Y) - ApplyDense(nuisance, Y)).cwiseAbs().maxCoeff(), 1e-9);
}

/// Taking each row's neighbour out, as noise that is correlated from reading to reading asks for, joins the blocks.
TEST(Projector, AgreesWithTheOrthogonalFactorisationWhereRowsTouchTwoBlocks) {
  Nuisance nuisance = ArrowNuisance();
  const Eigen::MatrixXd J = nuisance.jacobian;
  Eigen::MatrixXd joined = J;
  joined.bottomRows(kRows - 1) -= 0.4 * J.topRows(kRows - 1);
  nuisance.jacobian = joined.sparseView();
  const Projector projector(nuisance.jacobian, nuisance);
  const Eigen::MatrixXd Y = RandomMatrix("data", kRows, 5);
  EXPECT_LT((projector.Apply(Y) - ApplyDense(nuisance, Y)).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(Projector, GivesTheQuadraticFormWithoutFormingTheProjection) {
  const Nuisance nuisance = ArrowNuisance();
  const Projector projector(nuisance.jacobian, nuisance);
  const Eigen::MatrixXd S = RandomMatrix("signatures", kRows, 3);
  const Eigen::MatrixXd H = projector.Absorbed(S);
  const Eigen::MatrixXd expected = S.transpose() * ApplyDense(nuisance, S);
  EXPECT_LT((S.transpose() * S - H.transpose() * H - expected).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(Projector, CountsTheDegreesOfFreedomThatAreLeft) {
  const Nuisance nuisance = ArrowNuisance();
  const Projector projector(nuisance.jacobian, nuisance);
  const Eigen::MatrixXd W = ApplyDense(nuisance, Eigen::MatrixXd::Identity(kRows, kRows));
  EXPECT_NEAR(projector.DegreesOfFreedom(), W.trace(), 1e-9);
  // 7 x 2 local and 9 core unknowns, of which two are the same: 22. The weak prior takes nearly nothing.
  EXPECT_NEAR(projector.DegreesOfFreedom(), kRows - 22.0, 1e-3);
  EXPECT_LT((projector.Redundancy() - W.diagonal()).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(Projector, RefusesAnUnknownWithoutPrior) {
  Nuisance nuisance = ArrowNuisance();
  nuisance.prior_precision[3] = 0.0;
  EXPECT_THROW(Projector(nuisance.jacobian, nuisance), std::logic_error);
}

}  // namespace
}  // namespace twinbench::diagnose
