#include "twin/diagnose/engine/free_constants.h"

#include <algorithm>
#include <cmath>

#include "twin/core/errors.h"
#include "twin/core/linear_algebra.h"

namespace twinbench::diagnose {
namespace {

/// What the rows show of each constant, about the values that they have now.
void SetColumns(const Followed& twin, Eigen::Index rows, FreeConstants& free) {
  free.columns.resize(rows, free.values.size());
  Eigen::Index column = 0;
  for (const FreePoint& p : free.points) {
    const Eigen::MatrixXd slope = twin.Slope(p.point.name, free.Disturbances());
    for (const auto& course : p.courses.colwise()) free.columns.col(column++) = ByRow(course.asDiagonal() * slope);
  }
}

/// Columns over the noise, and below them what holds the constants without any reading: rows + constants.
Eigen::MatrixXd White(const FreeConstants& free, const FreeFit& how) {
  const Eigen::Index rows = free.columns.rows(), constants = free.columns.cols();
  Eigen::MatrixXd white = Eigen::MatrixXd::Zero(rows + constants, constants);
  white.topRows(rows) = how.weights.asDiagonal() * free.columns;
  white.bottomRows(constants).diagonal() = how.hold * free.Precision().cwiseSqrt();
  return white;
}

/// 1 / norm of each column, 0 of those that show next to nothing.
Eigen::VectorXd Alike(const Eigen::MatrixXd& white, double rank) {
  const Eigen::VectorXd norms = white.colwise().norm();
  return (norms.array() > rank * norms.maxCoeff()).select(norms.cwiseInverse(), 0.0);
}

/// The constants anew from what the residual still says of them. Columns are made alike first, so that what is not
/// fitted depends on no unit; of what is not, all that the constants have is kept least, not what this round adds.
Eigen::VectorXd Refitted(const FreeConstants& free, const Eigen::VectorXd& residual, const FreeFit& how) {
  Eigen::MatrixXd white = White(free, how);
  const Eigen::Index rows = residual.size();
  Eigen::VectorXd seen = Eigen::VectorXd::Zero(white.rows());
  seen.head(rows) = how.weights.cwiseProduct(residual) + white.topRows(rows) * free.values;
  const Eigen::VectorXd scale = Alike(white, how.rank);
  white *= scale.asDiagonal();
  const bool all_held = (free.Precision().array() > 0.0).all();
  if (all_held) return scale.cwiseProduct(SolveLeastSquares(white, seen).col(0));
  return scale.cwiseProduct(SolveRanked(white, seen, how.rank).x.col(0));
}

/// Each constant by itself, without those that show nothing, where the rest can be told apart; else combinations.
Eigen::MatrixXd Fitted(const FreeConstants& free, const FreeFit& how) {
  constexpr double kLeastRank = 1e-7;  // squares of less are rounding
  const double rank = std::max(how.rank, kLeastRank);
  const Eigen::MatrixXd white = White(free, how);
  const Eigen::VectorXd scale = Alike(white, rank);
  const Eigen::MatrixXd unit = white * scale.asDiagonal();
  const SymmetricEigen eigen = EigenOfSymmetric(unit.transpose() * unit);
  const Eigen::Index all = scale.size();
  const Eigen::Index apart = (eigen.values.array() > rank * rank * eigen.values[all - 1]).count();
  std::vector<Eigen::Index> seen;
  for (Eigen::Index k = 0; k < all; ++k) {
    if (scale[k] > 0.0) seen.push_back(k);
  }
  if (apart == std::ssize(seen)) return Eigen::MatrixXd::Identity(all, all)(Eigen::all, seen);
  return scale.asDiagonal() * eigen.vectors.rightCols(apart);
}

}  // namespace

std::vector<model::Disturbance> FreeConstants::Disturbances() const {
  std::vector<model::Disturbance> all;
  ForEach(values, [&](const FreePoint& p, const auto& x) { all.push_back({p.point.name, p.courses * x}); });
  return all;
}

Eigen::VectorXd FreeConstants::Precision() const {
  Eigen::VectorXd precision(values.size());
  Eigen::Index from = 0;
  for (const FreePoint& p : points) {
    precision.segment(from, p.courses.cols()).setConstant(p.sd > 0.0 ? std::pow(p.sd, -2) : 0.0);
    from += p.courses.cols();
  }
  return precision;
}

FreeConstants FitFree(const Followed& twin, std::vector<FreePoint> points, const Eigen::VectorXd& observed,
                      const FreeFit& how) {
  constexpr int kMostHalvings = 6;
  constexpr double kNoWorse = 1.001, kSettled = 1e-7;
  FreeConstants free;
  free.points = std::move(points);
  Eigen::Index constants = 0;
  for (const FreePoint& p : free.points) constants += p.courses.cols();
  free.values.setZero(constants);
  SetColumns(twin, observed.size(), free);
  free.fitted.resize(constants, 0);
  if (constants == 0) return free;
  Eigen::VectorXd residual;
  const auto misfit = [&] {
    residual = observed - ByRow(twin.Predict(free.Disturbances()));
    return how.weights.cwiseProduct(residual).norm();
  };
  double least = misfit();
  for (int k = 0; k < how.rounds; ++k) {
    if (k > 0) SetColumns(twin, observed.size(), free);
    const Eigen::VectorXd before = free.values;
    free.values = Refitted(free, residual, how);
    double now = misfit();
    // A step that leads out of what is nearly linear is shortened.
    for (int half = 0; half < kMostHalvings && !(now < kNoWorse * least); ++half) {
      free.values = 0.5 * (free.values + before);
      now = misfit();
    }
    const bool has_settled = k > 0 && least - now < kSettled * now;
    least = now;
    if (has_settled) break;
  }
  if (!free.values.allFinite() || !std::isfinite(least))
    throw InputError("readings", "no constants of the scenario's bench come near them: the fit leads to what is no number",
                     "readings of the bench that the scenario describes, and in its units");
  free.fitted = Fitted(free, how);
  return free;
}

}  // namespace twinbench::diagnose
