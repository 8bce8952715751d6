#include "twin/benches/rotary_4dof/estimators/weights.h"

#include <Eigen/LU>
#include <map>
#include <utility>

#include "twin/benches/rotary_4dof/estimators/grating_model.h"

namespace twinbench::separate {
namespace {

constexpr double kAssumedSpotNoise_m = 0.3e-6;  // starting weights if no noise is stated; residuals rescale it

Matrix4 ScaledCovariance(const Matrix4& cov, const Vector4& scale) {
  const Vector4 s = UnitScale().cwiseProduct(scale);
  return s.asDiagonal() * cov * s.asDiagonal();
}

std::map<std::pair<int, int>, Matrix4> PassCovariances(const std::vector<Motion>& motions, const Layout& layout) {
  std::map<std::pair<int, int>, std::pair<Matrix4, int>> sums;
  for (const Sample& sample : layout.samples) {
    const Motion& m = motions[sample.motion];
    auto& sum = sums.try_emplace({m.setup, m.pass}, Matrix4::Zero(), 0).first->second;
    sum.first += m.cov;
    ++sum.second;
  }
  std::map<std::pair<int, int>, Matrix4> means;
  for (const auto& [key, sum] : sums) means[key] = sum.first / sum.second;
  return means;
}

bool AllKnown(const std::vector<Motion>& motions, const Layout& layout) {
  for (const Sample& sample : layout.samples) {
    if (!motions[sample.motion].covariance_known) return false;
  }
  return true;
}

}  // namespace

Vector4 UnitScale() {
  return {1.0, 1.0, 1.0, 1.0 / kLengthUnit_m};
}

Matrix4 AssumedCovariance(const BenchGeometry& geometry) {
  const Matrix4 inverse = measure::SpotJacobian(Vector4::Zero(), geometry).inverse();
  return kAssumedSpotNoise_m * kAssumedSpotNoise_m * inverse * inverse.transpose();
}

Weights CollectWeights(const std::vector<Motion>& motions, const Layout& layout, const BenchGeometry& geometry,
                       const Vector4& scale) {
  Weights weights;
  weights.covariance_known = AllKnown(motions, layout);
  const auto of_pass = PassCovariances(motions, layout);
  const Matrix4 assumed = AssumedCovariance(geometry);
  std::map<std::pair<int, int>, std::size_t> index;
  for (const Sample& sample : layout.samples) {
    const Motion& m = motions[sample.motion];
    const Matrix4 cov = weights.covariance_known ? of_pass.at({m.setup, m.pass}) : assumed;
    weights.sample_cov.push_back(ScaledCovariance(cov, scale));
    const auto [entry, is_new] = index.try_emplace({sample.setup, sample.target}, weights.cells.size());
    if (is_new) weights.cells.push_back({sample.setup, sample.target, Matrix4::Zero()});
    weights.cell_of.push_back(entry->second);
    weights.cells[entry->second].weight += weights.sample_cov.back().inverse();
  }
  return weights;
}

}  // namespace twinbench::separate
