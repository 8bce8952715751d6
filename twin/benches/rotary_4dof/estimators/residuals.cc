#include "twin/benches/rotary_4dof/estimators/residuals.h"

#include <cmath>

#include "twin/core/distributions.h"

namespace twinbench::separate {
namespace {

constexpr double kTooUnlikely = 0.001;
constexpr double kBand = 0.01;  // of the largest of the four scales
constexpr double kLeastScale = 1e-9;

/// @param fitted  Variance of each cell's prediction.
Vector4 LeftOver(const Weights& weights, const std::vector<Vector4>& fitted) {
  Vector4 dof = Vector4::Zero();
  for (std::size_t k = 0; k < weights.cell_of.size(); ++k) {
    dof += Vector4::Ones() - fitted[weights.cell_of[k]].cwiseQuotient(weights.sample_cov[k].diagonal());
  }
  return dof;
}

double BirgeRatio(const Separation& result, int dof) {
  return std::sqrt(result.chi2[dof] / result.dof_of[dof]);
}

}  // namespace

Vector4 DegreesOfFreedom(const Weights& weights, const std::vector<StopModel>& models,
                         const NormalInverse& normal) {
  std::vector<Vector4> fitted;
  for (const StopModel& model : models) {
    const std::vector<int> columns(model.column.begin(), model.column.begin() + model.columns);
    const Eigen::MatrixXd d = model.d.leftCols(model.columns);
    fitted.push_back((d * normal.inverse(columns, columns)).cwiseProduct(d).rowwise().sum());
  }
  return LeftOver(weights, fitted);
}

Vector4 DegreesOfFreedom(const Weights& weights, const std::vector<StopModel>& models,
                         const OrderInverse& inverse) {
  return LeftOver(weights, inverse.FittedVariances(weights.cells, models));
}

void AddResiduals(const std::vector<Motion>& motions, const Layout& layout, const Weights& weights,
                  const Eigen::VectorXd& predicted, const Vector4& dof_of, Separation& result) {
  result.residuals.assign(motions.size(), Vector4::Constant(kNaN));
  Vector4 squares = Vector4::Zero();
  result.chi2.setZero();
  for (std::size_t k = 0; k < layout.samples.size(); ++k) {
    const std::size_t i = layout.samples[k].motion;
    const auto cell = static_cast<Eigen::Index>(weights.cell_of[k]);
    const Vector4 r = motions[i].Values().cwiseProduct(UnitScale()) - predicted.segment<4>(4 * cell);
    result.residuals[i] = r.cwiseQuotient(UnitScale());
    squares += result.residuals[i].cwiseAbs2();
    result.chi2 += r.cwiseAbs2().cwiseQuotient(weights.sample_cov[k].diagonal());
  }
  result.readings = static_cast<int>(layout.samples.size());
  result.residual_rms = (squares / result.readings).cwiseSqrt();
  result.dof_of = dof_of;
  result.dof = static_cast<int>(std::lround(dof_of.sum()));
}

Vector4 StatedNoiseScale(const Separation& result) {
  Vector4 scale = Vector4::Ones();
  for (int d = 0; d < measure::kDofs; ++d) {
    if (result.dof_of[d] < kLeastDof) continue;
    const bool unlikely = ChiSquaredExceedance(result.chi2[d], result.dof_of[d]) < kTooUnlikely;
    if (unlikely) scale[d] = BirgeRatio(result, d);
  }
  return scale;
}

Vector4 AssumedNoiseScale(const Separation& result, const BenchGeometry& geometry) {
  if (result.dof < 1) return Vector4::Ones();
  Vector4 scale =
      result.second_order.cwiseQuotient(AssumedCovariance(geometry).diagonal().cwiseSqrt()).cwiseMax(kLeastScale);
  for (int d = 0; d < measure::kDofs; ++d) {
    if (result.dof_of[d] >= kLeastDof) scale[d] = std::max(scale[d], BirgeRatio(result, d));
  }
  return scale.cwiseMax(kBand * scale.maxCoeff());
}

}  // namespace twinbench::separate
