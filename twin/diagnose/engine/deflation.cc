#include <utility>

#include "twin/core/linear_algebra.h"
#include "twin/diagnose/engine/scanner.h"

namespace twinbench::diagnose {
namespace {

constexpr double kDependent = 1e-4;  // share of a signature's power that must survive projection

}  // namespace

Deflation::Deflation(const Projector& projector, const Eigen::MatrixXd& columns) {
  if (columns.cols() == 0) return;
  projected_ = projector.Apply(columns);
  const Eigen::MatrixXd gram = columns.transpose() * projected_;
  const Eigen::VectorXd scale = gram.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  const auto [values, vectors] = EigenOfSymmetric(scale.asDiagonal() * gram * scale.asDiagonal());
  const auto kept = static_cast<int>((values.array() > kDependent).count());
  transform_ =
      scale.asDiagonal() * vectors.rightCols(kept) * values.tail(kept).cwiseSqrt().cwiseInverse().asDiagonal();
  basis_ = projected_ * transform_;
  dual_ = columns * transform_;
  solve_ = transform_ * dual_.transpose();
  covariance_ = transform_ * transform_.transpose();
}

Eigen::MatrixXd Deflation::Apply(const Eigen::MatrixXd& projected) const {
  if (Rank() == 0) return projected;
  return projected - basis_ * Along(projected);
}

Projected Project(const Projector& projector, const Deflation& deflation, const Eigen::MatrixXd& white) {
  Projected data;
  data.rows = projector.Apply(white);
  if (deflation.Rank() > 0) {
    data.taken = deflation.Along(data.rows);
    data.before = std::move(data.rows);
    data.rows = data.before - deflation.Basis() * data.taken;
  }
  data.power = white.cwiseProduct(data.rows).colwise().sum();
  return data;
}

Misfit FreeMisfit(const LinearRun& run) {
  const NoiseModel noise{run.sigma, {}};
  const Projector projector(noise.Whiten(run, run.nuisance.jacobian), run.nuisance);
  const Eigen::MatrixXd white = noise.Whiten(run, Eigen::MatrixXd(run.residual));
  return {Project(projector, {}, white).power[0], projector.DegreesOfFreedom()};
}

}  // namespace twinbench::diagnose
