#include "twin/benches/rotary_4dof/estimators/residuals.h"

#include <algorithm>
#include <array>
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

struct ChiSquared {
  double sum, dof;

  double BirgeRatio() const { return std::sqrt(sum / dof); }
  bool TooUnlikely() const { return dof >= kLeastDof && ChiSquaredExceedance(sum, dof) < kTooUnlikely; }
};

/// Of all residuals, and of the means of the passes at each stop of a set-up: what all passes repeat there is small beside
/// what they scatter by, but no more passes make it less.
std::array<ChiSquared, 2> TestsOf(const Separation& result, int motion) {
  return {{{result.chi2[motion], result.dof_of[motion]}, {result.chi2_of_stops[motion], result.dof_of_stops[motion]}}};
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
  std::vector<Vector4> weight(weights.cells.size(), Vector4::Zero()), weighted = weight;
  for (std::size_t k = 0; k < layout.samples.size(); ++k) {
    const std::size_t i = layout.samples[k].motion;
    const auto cell = static_cast<Eigen::Index>(weights.cell_of[k]);
    const Vector4 r = motions[i].Values().cwiseProduct(UnitScale()) - predicted.segment<4>(4 * cell);
    result.residuals[i] = r.cwiseQuotient(UnitScale());
    squares += result.residuals[i].cwiseAbs2();
    result.chi2 += r.cwiseAbs2().cwiseQuotient(weights.sample_cov[k].diagonal());
    weight[weights.cell_of[k]] += weights.sample_cov[k].diagonal().cwiseInverse();
    weighted[weights.cell_of[k]] += r.cwiseQuotient(weights.sample_cov[k].diagonal());
  }
  result.chi2_of_stops.setZero();
  for (std::size_t c = 0; c < weight.size(); ++c) result.chi2_of_stops += weighted[c].cwiseAbs2().cwiseQuotient(weight[c]);
  result.readings = static_cast<int>(layout.samples.size());
  result.residual_rms = (squares / result.readings).cwiseSqrt();
  result.dof_of = dof_of;
  const double repeats = static_cast<double>(layout.samples.size()) - static_cast<double>(weights.cells.size());
  result.dof_of_stops = dof_of - Vector4::Constant(repeats);
  result.dof = static_cast<int>(std::lround(dof_of.sum()));
}

Vector4 StatedNoiseScale(const Separation& result) {
  Vector4 scale = Vector4::Ones();
  for (int d = 0; d < measure::kDofs; ++d) {
    for (const ChiSquared& test : TestsOf(result, d)) {
      if (test.TooUnlikely()) scale[d] = std::max(scale[d], test.BirgeRatio());
    }
  }
  return scale;
}

Vector4 AssumedNoiseScale(const Separation& result, const BenchGeometry& geometry) {
  if (result.dof < 1) return Vector4::Ones();
  Vector4 scale =
      result.second_order.cwiseQuotient(AssumedCovariance(geometry).diagonal().cwiseSqrt()).cwiseMax(kLeastScale);
  for (int d = 0; d < measure::kDofs; ++d) {
    const auto [all, stops] = TestsOf(result, d);
    if (all.dof < kLeastDof) continue;
    scale[d] = std::max(scale[d], all.BirgeRatio());
    const double beside = stops.sum / std::pow(all.BirgeRatio(), 2);  // against the noise that all residuals say
    if (ChiSquared{beside, stops.dof}.TooUnlikely()) scale[d] = std::max(scale[d], stops.BirgeRatio());
  }
  return scale.cwiseMax(kBand * scale.maxCoeff());
}

}  // namespace twinbench::separate
