#include "twin/benches/rotary_4dof/estimators/separator.h"

#include <cmath>
#include <utility>

#include "twin/benches/rotary_4dof/estimators/prediction.h"
#include "twin/benches/rotary_4dof/estimators/residuals.h"
#include "twin/core/errors.h"
#include "twin/core/linear_algebra.h"

namespace twinbench::separate {
namespace {

constexpr int kMostRounds = 4;
constexpr double kLastStep = 1e-12;  // 0.2 microarcsec, 0.1 pm

/// Largest ratio that errors of standard deviation `u` [rad, m] have to the variance of a cell, in any direction.
double LargestRatio(const std::vector<Cell>& cells, const Vector4& u) {
  const Vector4 scaled = u.cwiseProduct(UnitScale());
  double largest = 0.0;
  for (const Cell& cell : cells) {
    const Matrix4 ratio = scaled.asDiagonal() * cell.weight * scaled.asDiagonal();
    if (ratio.trace() <= largest) continue;  // the trace is never below the largest eigenvalue
    largest = std::max(largest, EigenvaluesOfSymmetric(ratio)[3]);
  }
  return largest;
}

}  // namespace

Separator::Separator(const std::vector<Motion>& motions, const BenchGeometry& geometry,
                     const SeparateOptions& options)
    : geometry_(geometry),
      cov_calibration_(options.cov_calibration),
      layout_(FindLayout(motions, geometry, options.layout)),
      separability_(FindSeparability(layout_.design)) {
  Factorise(motions);
}

void Separator::Factorise(const std::vector<Motion>& motions) {
  weights_ = CollectWeights(motions, layout_, geometry_, scale_);
  models_.clear();
  for (const Cell& cell : weights_.cells) models_.push_back(ModelStop(design(), cell.setup, cell.target));
  Invert();
  std::visit(
      [this](const auto& inverse) {
        target_ = MakeTablePart(design(), Table::kTarget, separability_.lost, inverse);
        reference_ = MakeTablePart(design(), Table::kReference, separability_.lost, inverse);
      },
      normal_);
}

/// Order by order if little is missing; else as one matrix.
void Separator::Invert() {
  if (auto by_order = OrderInverse::Of(design(), separability_.orders, weights_.cells)) {
    dof_of_ = DegreesOfFreedom(weights_, models_, *by_order);
    normal_ = *std::move(by_order);
    return;
  }
  auto inverse = InvertNormal(design(), weights_.cells, models_, NullSpace(design(), separability_.orders));
  dof_of_ = DegreesOfFreedom(weights_, models_, inverse);
  normal_ = std::move(inverse);
}

void Separator::Rescale(const std::vector<Motion>& motions, const Vector4& factor) {
  Require(Fits(motions), "the motions have another layout than those the Separator was made for");
  scale_ = scale_.cwiseProduct(factor);
  if ((factor.array() != factor[0]).any()) return Factorise(motions);
  const double variance = factor[0] * factor[0];
  for (Matrix4& cov : weights_.sample_cov) cov *= variance;
  for (Cell& cell : weights_.cells) cell.weight /= variance;
  std::visit([variance](auto& inverse) { inverse.Scale(variance); }, normal_);
  target_.cov = target_.cov * variance;
  reference_.cov = reference_.cov * variance;
}

bool Separator::Fits(const std::vector<Motion>& motions) const {
  std::size_t used = 0;
  for (std::size_t i = 0; i < motions.size(); ++i) {
    if (motions[i].phase != Phase::kFullCircle || motions[i].status != ReadingStatus::kOk) continue;
    if (used >= layout_.samples.size() || layout_.samples[used].motion != i) return false;
    const Sample& sample = layout_.samples[used++];
    const double steps = (motions[i].target_rad - design().TargetAngle_rad(sample.target)) / design().Step_rad();
    const SetUp& setup = design().setups[static_cast<std::size_t>(sample.setup)];
    const bool same_stop = std::abs(std::remainder(steps, design().n)) < 1e-2 && motions[i].setup == setup.label;
    if (!same_stop) return false;
  }
  return used == layout_.samples.size();
}

/// Unknowns by least squares from values of the cells, four rows a cell.
Eigen::MatrixXd Separator::Propagate(const Eigen::MatrixXd& cell_values) const {
  Eigen::MatrixXd right = Eigen::MatrixXd::Zero(design().Unknowns(), cell_values.cols());
  for (std::size_t k = 0; k < models_.size(); ++k) {
    const Eigen::MatrixXd weighted =
        weights_.cells[k].weight * cell_values.middleRows<4>(4 * static_cast<Eigen::Index>(k));
    for (int c = 0; c < models_[k].columns; ++c) {
      right.row(models_[k].column[c]) += models_[k].d.col(c).transpose() * weighted;
    }
  }
  return std::visit([&right](const auto& inverse) -> Eigen::MatrixXd { return inverse * right; }, normal_);
}

/// Gauss-Newton with the first-order model as fixed Jacobian: each round gains a factor of the errors' size (1e-4).
Eigen::VectorXd Separator::SolveIterated(const std::vector<Motion>& motions) const {
  const Eigen::VectorXd means = CellMeans(weights_, 1, [&](std::size_t k) -> Vector4 {
    return motions[layout_.samples[k].motion].Values().cwiseProduct(UnitScale());
  });
  Eigen::VectorXd x = Eigen::VectorXd::Zero(design().Unknowns());
  for (int round = 0; round < kMostRounds; ++round) {
    const Eigen::VectorXd step = Propagate(means - PredictCells(design(), weights_.cells, x, geometry_));
    x += step;
    if (step.cwiseAbs().maxCoeff() < kLastStep) break;
  }
  return x;
}

/// The calibration from the motions' own sensitivities; the second order as its largest ratio to the random part,
/// which bounds its covariance from above whatever its pattern over the cells.
Systematic Separator::FindSystematic(const std::vector<Motion>& motions, const Vector4& second_order) const {
  Systematic systematic;
  systematic.second_order = LargestRatio(weights_.cells, second_order);
  systematic.cov_calibration = cov_calibration_;
  if (cov_calibration_.isZero(0.0)) return systematic;
  systematic.d_calibration = Propagate(CellMeans(weights_, 6, [&](std::size_t k) -> measure::Matrix46 {
    return UnitScale().asDiagonal() * motions[layout_.samples[k].motion].d_calibration;
  }));
  return systematic;
}

Separation Separator::Separate(const std::vector<Motion>& motions) const {
  Require(Fits(motions), "the motions have another layout than those the Separator was made for");
  const Eigen::VectorXd x = SolveIterated(motions);
  Separation result;
  result.second_order = UnreadSecondOrder(design(), x);
  const Systematic systematic = FindSystematic(motions, result.second_order);
  result.not_separable = separability_.lost;
  result.scale = scale_;
  result.target = EstimateTable(target_, x, systematic);
  result.reference = EstimateTable(reference_, x, systematic);
  for (std::size_t s = 0; s < design().setups.size(); ++s) {
    const Vector4 mount = x.segment<4>(design().MountColumn(static_cast<int>(s)));
    result.mount.push_back(mount.cwiseQuotient(UnitScale()));
  }
  AddResiduals(motions, layout_, weights_, PredictCells(design(), weights_.cells, x, geometry_), dof_of_, result);
  return result;
}

}  // namespace twinbench::separate
