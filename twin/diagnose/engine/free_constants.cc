#include "twin/diagnose/engine/free_constants.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "twin/core/errors.h"
#include "twin/core/linear_algebra.h"
#include "twin/diagnose/engine/projector.h"

namespace twinbench::diagnose {
namespace {

/// What the rows show of each constant, about the values that they have now.
void SetColumns(const Followed& twin, Eigen::Index rows, FreeConstants& free) {
  free.columns.resize(rows, free.values.size());
  Eigen::Index column = 0;
  std::map<std::string, Eigen::MatrixXd> slopes;
  for (const FreePoint& p : free.points) {
    if (!slopes.contains(p.point.name)) slopes[p.point.name] = twin.Slope(p.point.name, free.Disturbances());
    const Eigen::MatrixXd& slope = slopes[p.point.name];
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

int LocalPoints(const FreeConstants& free) {
  return static_cast<int>(std::ranges::count(free.points, true, &FreePoint::is_local));
}

/// All constants, the local ones place by place: each place is a block of its own (Nuisance).
std::vector<Eigen::Index> ByPlace(const FreeConstants& free) {
  const int size = LocalPoints(free);
  const Eigen::Index places = free.points.front().courses.cols();
  std::vector<Eigen::Index> order;
  for (Eigen::Index place = 0; place < places; ++place) {
    for (int p = 0; p < size; ++p) order.push_back(p * places + place);
  }
  for (Eigen::Index k = size * places; k < free.values.size(); ++k) order.push_back(k);
  return order;
}

/// As Refitted, of many that are local: place by place.
Eigen::VectorXd RefittedByPlace(const FreeConstants& free, const Eigen::VectorXd& residual, const FreeFit& how) {
  Nuisance nuisance = free.AsNuisance(how.weights, how.hold);
  nuisance.jacobian = how.weights.asDiagonal() * nuisance.jacobian;
  const Eigen::VectorXd seen = how.weights.cwiseProduct(residual + free.columns * free.values);
  Eigen::VectorXd values(free.values.size());
  values(free.told) = Projector(nuisance.jacobian, nuisance).Solve(seen).col(0);
  return values;
}

/// Each constant by itself, without those that show nothing, where the rest can be told apart; else combinations.
void SetFitted(const FreeFit& how, FreeConstants& free) {
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
  if (apart == std::ssize(seen)) {
    free.told = seen;
    free.fitted = Eigen::MatrixXd::Identity(all, all)(Eigen::all, seen);
  } else {
    free.fitted = scale.asDiagonal() * eigen.vectors.rightCols(apart);
  }
}

}  // namespace

std::vector<model::Disturbance> FreeConstants::DisturbancesOf(const Eigen::VectorXd& constants) const {
  std::vector<model::Disturbance> all;
  ForEach(constants, [&](const FreePoint& p, const auto& x) { all.push_back({p.point.name, p.courses * x}); });
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

Eigen::VectorXd FreeConstants::FittedValues() const {
  return told.empty() ? SolveLeastSquares(fitted, values).col(0) : Eigen::VectorXd(values(told));
}

Nuisance FreeConstants::AsNuisance(const Eigen::VectorXd& weights, double hold) const {
  constexpr double kWeak = 1e-6;
  const Eigen::MatrixXd shown = told.empty() ? Eigen::MatrixXd(columns * fitted) : columns(Eigen::all, told);
  const Eigen::MatrixXd white = weights.asDiagonal() * shown;
  const Eigen::VectorXd weak = kWeak * white.cwiseAbs2().colwise().maxCoeff().transpose().cwiseMax(1e-300);
  const Eigen::VectorXd stated = hold * hold * (fitted.cwiseAbs2().transpose() * Precision());
  const int local = LocalPoints(*this);
  const int places = local > 0 ? static_cast<int>(points.front().courses.cols()) : 0;
  return {shown.sparseView(), (stated.array() > 0.0).select(stated, weak), places, local};
}

FreeConstants FitFree(const Followed& twin, std::vector<FreePoint> points, const Eigen::VectorXd& observed,
                      const FreeFit& how) {
  constexpr int kMostHalvings = 6;
  constexpr double kNoWorse = 1.001, kSettled = 1e-7;
  constexpr double kLinear = 0.1;  // noise standard deviations, of all rows together
  FreeConstants free;
  free.points = std::move(points);
  Eigen::Index constants = 0;
  for (const FreePoint& p : free.points) constants += p.courses.cols();
  free.values.setZero(constants);
  SetColumns(twin, observed.size(), free);
  free.fitted.resize(constants, 0);
  if (constants == 0) return free;
  const bool by_place = LocalPoints(free) > 0;
  if (by_place) {
    free.told = ByPlace(free);
    free.fitted = Eigen::MatrixXd::Identity(constants, constants)(Eigen::all, free.told);
  }
  Eigen::VectorXd residual;
  const auto misfit = [&] {
    residual = observed - ByRow(twin.Predict(free.Disturbances()));
    return how.weights.cwiseProduct(residual).norm();
  };
  double least = misfit();
  for (int k = 0; k < how.rounds; ++k) {
    if (k > 0) SetColumns(twin, observed.size(), free);
    const Eigen::VectorXd before = free.values;
    const Eigen::VectorXd left_before = residual;
    free.values = by_place ? RefittedByPlace(free, residual, how) : Refitted(free, residual, how);
    double now = misfit();
    // A step that leads out of what is nearly linear is shortened.
    for (int half = 0; half < kMostHalvings && !(now < kNoWorse * least); ++half) {
      free.values = 0.5 * (free.values + before);
      now = misfit();
    }
    // New slopes would tell nothing where the old ones said what is left.
    const bool is_linear =
        how.weights.cwiseProduct(left_before - free.columns * (free.values - before) - residual).norm() < kLinear;
    const bool has_settled = is_linear || (k > 0 && least - now < kSettled * now);
    least = now;
    if (has_settled) break;
  }
  if (!free.values.allFinite() || !std::isfinite(least))
    throw InputError("readings", "no constants of the scenario's bench come near them: the fit leads to what is no number",
                     "readings of the bench that the scenario describes, and in its units");
  if (!by_place) SetFitted(how, free);
  return free;
}

}  // namespace twinbench::diagnose
