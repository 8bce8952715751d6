#include "twin/import/by_speed.h"

#include <cmath>

#include "twin/core/linear_algebra.h"
#include "twin/core/units.h"

namespace twinbench::imports {
namespace {

/// From the row before to the row behind, by row; 0 at the ends.
Eigen::VectorXd StepsThrough(const Eigen::VectorXd& place) {
  const Eigen::Index inner = place.size() - 2;
  Eigen::VectorXd steps = Eigen::VectorXd::Zero(place.size());
  steps.segment(1, inner) = 0.5 * (place.tail(inner) - place.head(inner));
  return steps;
}

/// Neighbouring steps are nearly the same, and over the whole they are not: it speeds up and slows down.
bool IsSmoothProfile(const Eigen::VectorXd& place) {
  constexpr double kAlike = 0.95, kVaries = 0.3;
  const Eigen::Index n = place.size() - 1;
  const Eigen::VectorXd step = place.tail(n) - place.head(n);
  const double mean = step.cwiseAbs().mean(), varies = (step.cwiseAbs().array() - mean).matrix().norm() / std::sqrt(static_cast<double>(n));
  return step.head(n - 1).dot(step.tail(n - 1)) > kAlike * step.squaredNorm() && varies > kVaries * mean;
}

}  // namespace

double RowsBehindBySpeed(const std::vector<double>& command, const std::vector<double>& shown) {
  constexpr std::size_t kFewest = 50;
  constexpr double kShare = 0.5;
  if (command.size() < kFewest) return 0.0;
  const auto n = static_cast<Eigen::Index>(command.size());
  const Eigen::Map<const Eigen::VectorXd> place(command.data(), n), device(shown.data(), n);
  if (!IsSmoothProfile(place)) return 0.0;
  const double first = device[0] - place[0];
  const Eigen::VectorXd error =
      (device - place).unaryExpr([first](double e) { return std::remainder(e - first, units::turn); });
  Eigen::MatrixXd columns(n, 4);
  const Eigen::VectorXd steps = StepsThrough(place);
  columns << Eigen::VectorXd::Ones(n), place, steps.cwiseSign(), steps;
  const Eigen::MatrixXd others = columns.leftCols(3);
  const Eigen::VectorXd sizes = SolveShortest(columns, error);
  const double left = (error - columns * sizes).squaredNorm(), beside = (error - others * SolveShortest(others, error)).squaredNorm();
  return left < kShare * beside ? -sizes[3] : 0.0;
}

}  // namespace twinbench::imports
