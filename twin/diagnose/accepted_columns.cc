#include "twin/diagnose/accepted_columns.h"

#include "twin/core/errors.h"
#include "twin/core/linear_algebra.h"

namespace twinbench::diagnose {

Columns ColumnsOf(const std::vector<Accepted>& accepted, int rows) {
  Eigen::Index count = 0;
  for (const Accepted& a : accepted) count += a.columns.cols();
  Columns all{Eigen::MatrixXd(rows, count), Eigen::VectorXd(count)};
  Eigen::Index column = 0;
  for (const Accepted& a : accepted) {
    Require(a.columns.rows() == rows && static_cast<std::size_t>(a.columns.cols()) == a.family.amplitudes.size(),
            "an accepted cause has a column of the run's rows for each amplitude");
    all.S.middleCols(column, a.columns.cols()) = a.columns;
    for (const Amplitude& amplitude : a.family.amplitudes)
      all.prior_precision[column++] = 1.0 / (amplitude.prior_sd * amplitude.prior_sd);
  }
  return all;
}

Eigen::MatrixXd RelativeCovariance(const Projector& projector, const Eigen::MatrixXd& S,
                                   const Eigen::VectorXd& prior_precision) {
  const Eigen::MatrixXd scaled = S * prior_precision.cwiseSqrt().cwiseInverse().asDiagonal();
  Eigen::MatrixXd normal = scaled.transpose() * projector.Apply(scaled);
  normal.diagonal().array() += 1.0;
  return SolvePositive(normal, Eigen::MatrixXd(Eigen::MatrixXd::Identity(normal.rows(), normal.cols())));
}

Eigen::VectorXd FitAmplitudes(const Projector& projector, const Eigen::MatrixXd& S, const Eigen::MatrixXd& y,
                              const Eigen::VectorXd& prior_precision) {
  // In units of the prior deviation, so that amplitudes of any unit stand beside each other.
  const Eigen::VectorXd sd = prior_precision.array().rsqrt();
  const Eigen::MatrixXd scaled = S * sd.asDiagonal();
  const Eigen::MatrixXd projected = projector.Apply(scaled);
  Eigen::MatrixXd normal = scaled.transpose() * projected;
  normal.diagonal().array() += 1.0;
  return sd.cwiseProduct(SolveSymmetric(normal, Eigen::MatrixXd(projected.transpose() * y)));
}

LeftOver FitAll(const LinearRun& run, const NoiseModel& noise, const std::vector<Accepted>& accepted) {
  const Projector projector(noise.Whiten(run, run.nuisance.jacobian), run.nuisance);
  const Eigen::MatrixXd y = noise.Whiten(run, Eigen::MatrixXd(run.residual));
  const Columns columns = ColumnsOf(accepted, run.Rows());
  LeftOver left;
  left.unknowns_before = projector.Solve(y);
  left.before = run.residual - run.nuisance.jacobian * left.unknowns_before;
  left.unknowns_after = left.unknowns_before;
  left.after = left.before;
  if (accepted.empty()) return left;
  const Eigen::MatrixXd S = noise.Whiten(run, columns.S);
  const Eigen::VectorXd amplitudes = FitAmplitudes(projector, S, y, columns.prior_precision);
  left.unknowns_after = projector.Solve(y - S * amplitudes);
  left.after = run.residual - columns.S * amplitudes - run.nuisance.jacobian * left.unknowns_after;
  return left;
}

}  // namespace twinbench::diagnose
