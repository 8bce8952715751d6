#include "twin/uncertainty/joint.h"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <map>

#include "twin/core/linear_algebra.h"

namespace twinbench::uncertainty {
namespace {

constexpr double kNoDirection = 1e-10;
constexpr double kCovered = 0.95;

/// Standard uncertainties; one where a quantity is certain, so that it may be divided by.
Eigen::VectorXd ScaleOf(const Eigen::MatrixXd& cov) {
  const Eigen::ArrayXd variance = cov.diagonal().array().max(0.0);
  return (variance > 0.0).select(variance.sqrt(), 1.0);
}

/// Eigenvectors of the correlation that count, and their variances.
struct Directions {
  Eigen::VectorXd scale, variances;
  Eigen::MatrixXd vectors;
};

Directions DirectionsOf(const Eigen::MatrixXd& cov) {
  const Eigen::VectorXd scale = ScaleOf(cov), over = scale.cwiseInverse();
  const SymmetricEigen eigen = EigenOfSymmetric(over.asDiagonal() * cov * over.asDiagonal());
  const double largest = eigen.values.size() > 0 ? eigen.values.maxCoeff() : 0.0;
  const Eigen::Index rank = (eigen.values.array() > kNoDirection * largest).count();
  return {scale, eigen.values.tail(rank), eigen.vectors.rightCols(rank)};
}

double QuantileOf(std::vector<double> values) {
  std::ranges::sort(values);
  const auto at = static_cast<std::size_t>(std::ceil(kCovered * static_cast<double>(values.size()))) - 1;
  return values[std::min(at, values.size() - 1)];
}

Region RegionOf(const Eigen::MatrixXd& from_mean, const Eigen::MatrixXd& cov) {
  const Directions d = DirectionsOf(cov);
  Region region;
  region.dimensions = static_cast<int>(d.variances.size());
  if (region.dimensions == 0) return region;
  const Eigen::MatrixXd scaled = from_mean * d.scale.cwiseInverse().asDiagonal();
  const Eigen::VectorXd farthest = scaled.cwiseAbs().rowwise().maxCoeff();
  region.rectangle_k = QuantileOf({farthest.begin(), farthest.end()});
  region.ellipsoid_gum_k = std::sqrt(quantile(boost::math::chi_squared(region.dimensions), kCovered));
  region.ellipsoid_k = std::numeric_limits<double>::quiet_NaN();
  if (from_mean.rows() < 10 * region.dimensions) return region;
  const Eigen::MatrixXd along = scaled * d.vectors * d.variances.cwiseSqrt().cwiseInverse().asDiagonal();
  const Eigen::VectorXd square = along.rowwise().squaredNorm();
  region.ellipsoid_k = std::sqrt(QuantileOf({square.begin(), square.end()}));
  return region;
}

}  // namespace

Joint Determined(const Joint& joint, const std::vector<std::string>& known) {
  std::vector<Eigen::Index> kept;
  Joint determined{joint.name, {}, {}};
  for (std::size_t i = 0; i < joint.names.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    if (!std::isfinite(joint.cov(at, at)) || std::ranges::find(known, joint.names[i]) == known.end()) continue;
    kept.push_back(at);
    determined.names.push_back(joint.names[i]);
  }
  determined.cov = joint.cov(kept, kept);
  return determined;
}

Joint Combined(const Joint& joint, const std::vector<Budget>& budgets) {
  std::map<std::string, Eigen::VectorXd> of_source;
  Joint combined = joint;
  for (const Budget& budget : budgets) {
    const auto found = std::ranges::find(joint.names, budget.quantity.name);
    if (found == joint.names.end()) continue;
    const Eigen::Index at = found - joint.names.begin();
    double others = budget.u * budget.u - budget.quantity.u * budget.quantity.u;
    for (const Source& source : budget.sources) {
      if (IsOfReadings(source)) continue;
      others -= source.u * source.u;
      of_source.try_emplace(source.name, Eigen::VectorXd::Zero(joint.cov.rows())).first->second[at] = source.u;
    }
    combined.cov(at, at) += std::max(0.0, others);  // second order
  }
  for (const auto& [name, u] : of_source) combined.cov += u * u.transpose();
  return combined;
}

Eigen::MatrixXd CorrelationOf(const Eigen::MatrixXd& cov) {
  const Eigen::VectorXd over = ScaleOf(cov).cwiseInverse();
  return over.asDiagonal() * cov * over.asDiagonal();
}

Eigen::MatrixXd RootOf(const Eigen::MatrixXd& cov) {
  const Directions d = DirectionsOf(cov);
  return d.scale.asDiagonal() * d.vectors * d.variances.cwiseSqrt().asDiagonal();
}

JointSpread SpreadOfTrials(const Joint& joint, const Eigen::MatrixXd& trials) {
  const Eigen::MatrixXd from_mean = trials.rowwise() - trials.colwise().mean();
  JointSpread spread{{joint.name, joint.names, {}}, {}};
  spread.joint.cov = from_mean.transpose() * from_mean / static_cast<double>(trials.rows() - 1);
  spread.region = RegionOf(from_mean, spread.joint.cov);
  return spread;
}

}  // namespace twinbench::uncertainty
