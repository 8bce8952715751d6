#include "twin/benches/turntable_autocollimator/estimators/shift_fit.h"

#include <array>
#include <cmath>

#include "twin/benches/turntable_autocollimator/estimators/lost_harmonics.h"
#include "twin/core/errors.h"
#include "twin/core/linear_algebra.h"

namespace twinbench::separate::turntable {
namespace {

constexpr double kDefective = 1e-12;  // reciprocal condition; two shifts at n = 720 have 1e-8

/// The three unknowns of one reading.
std::array<Eigen::Index, 3> Columns(const StopGrid& grid, const GridStop& stop) {
  return {stop.position, grid.n + stop.tooth, grid.n + grid.Teeth() + stop.setup};
}

}  // namespace

ShiftFit::ShiftFit(const StopGrid& grid)
    : grid_(grid),
      common_steps_(CommonSteps(grid)),
      unknowns_(grid.n + grid.Teeth() + static_cast<int>(grid.setups.size())) {
  const Eigen::MatrixXd normal = NormalMatrix();
  readings_of_ = normal.diagonal();
  // Rows of weight 1 beside the readings fix each choice exactly and change nothing else.
  const Eigen::MatrixXd choices = Choices();
  Eigen::MatrixXd whole = normal + choices.transpose() * choices;
  whole.diagonal() += (readings_of_.array() == 0.0).cast<double>().matrix();
  const auto inverse = InverseOfPositive(whole, kDefective);
  determined_ = inverse.has_value();
  cofactor_ = Eigen::MatrixXd::Constant(unknowns_, unknowns_, kNaN);
  if (!determined_) return;
  inverse_ = *inverse;
  const Eigen::MatrixXd projector = inverse_ * normal;
  cofactor_ = projector * inverse_;
  dof_ = static_cast<double>(grid_.stops.size()) - projector.trace();
}

Eigen::MatrixXd ShiftFit::NormalMatrix() const {
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(unknowns_, unknowns_);
  for (const GridStop& stop : grid_.stops) {
    for (const Eigen::Index a : Columns(grid_, stop)) {
      for (const Eigen::Index b : Columns(grid_, stop)) normal(a, b) += 1.0;
    }
  }
  return normal;
}

/// Sums that are made zero: of T, of each row of R, and of R over all teeth that meet positions of the same
/// remainder by the common steps.
Eigen::MatrixXd ShiftFit::Choices() const {
  const int rows = static_cast<int>(grid_.row_offset_rad.size());
  Eigen::MatrixXd choices = Eigen::MatrixXd::Zero(1 + rows + common_steps_, unknowns_);
  for (const GridStop& stop : grid_.stops) {
    const auto [position, tooth, setup] = Columns(grid_, stop);
    choices(0, position) = 1.0;
    choices(1 + stop.tooth / grid_.n, tooth) = 1.0;
    choices(1 + rows + stop.position % common_steps_, tooth) = 1.0;
  }
  return choices.rowwise().norm().cwiseMax(1.0).cwiseInverse().asDiagonal() * choices;
}

Eigen::VectorXd ShiftFit::ToUnknowns(const Eigen::VectorXd& values) const {
  Require(values.size() == std::ssize(grid_.stops), "one value a stop of the grid");
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(unknowns_);
  for (std::size_t k = 0; k < grid_.stops.size(); ++k) {
    for (const Eigen::Index c : Columns(grid_, grid_.stops[k])) sums[c] += values[static_cast<Eigen::Index>(k)];
  }
  return sums;
}

Eigen::VectorXd ShiftFit::Unknowns(const Eigen::VectorXd& values) const {
  if (!determined_) return Eigen::VectorXd::Constant(unknowns_, kNaN);
  return inverse_ * ToUnknowns(values);
}

Eigen::VectorXd ShiftFit::Solve(const Eigen::VectorXd& values) const {
  return (readings_of_.array() > 0.0).select(Unknowns(values), kNaN);
}

Eigen::VectorXd ShiftFit::Residuals(const Eigen::VectorXd& values) const {
  const Eigen::VectorXd unknowns = Unknowns(values);
  Eigen::VectorXd rest = values;
  for (std::size_t k = 0; k < grid_.stops.size(); ++k) {
    for (const Eigen::Index c : Columns(grid_, grid_.stops[k])) rest[static_cast<Eigen::Index>(k)] -= unknowns[c];
  }
  return rest;
}

}  // namespace twinbench::separate::turntable
