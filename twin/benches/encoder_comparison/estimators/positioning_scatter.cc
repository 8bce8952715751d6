#include "twin/benches/encoder_comparison/estimators/positioning_scatter.h"

#include <cmath>

#include "twin/core/stream.h"

namespace twinbench::measure {
namespace {

using Eigen::ArrayXd;

Side SideOf(const std::vector<TargetPositioning>& targets, ApproachPositioning TargetPositioning::*approach) {
  const Eigen::Index size = std::ssize(targets);
  Side side{ArrayXd(size), ArrayXd(size), ArrayXd(size), ArrayXd(size)};
  for (Eigen::Index i = 0; i < size; ++i) {
    const ApproachPositioning& a = targets[static_cast<std::size_t>(i)].*approach;
    side.runs[i] = a.runs;
    side.mean[i] = a.mean;
    side.deviation[i] = a.deviation;
    side.rounding[i] = a.rounding;
  }
  return side;
}

/// What the same number of runs could have given: mean normal, variance chi-squared. What rounding hides is scattered too.
Side Again(const Side& side, Stream& stream) {
  Side again = side;
  for (Eigen::Index i = 0; i < side.mean.size(); ++i) {
    const double freedom = side.runs[i] - 1.0;
    const double chi_squared = freedom > 0.0 ? stream.ChiSquared(freedom) : kNaN;
    again.mean[i] += std::hypot(side.deviation[i] / std::sqrt(side.runs[i]), side.rounding[i]) * stream.Normal();
    const double hidden = std::hypot(side.deviation[i], side.rounding[i]) - side.deviation[i];
    again.deviation[i] = std::abs((side.deviation[i] + hidden) * std::sqrt(chi_squared / freedom) - hidden);
  }
  return again;
}

}  // namespace

std::vector<ScatteredValue> WithScatter(const std::vector<TargetPositioning>& targets, const AxisFigures& figures,
                                        const PositioningBootstrap& bootstrap, const std::string& name) {
  const Side f = SideOf(targets, &TargetPositioning::forward), b = SideOf(targets, &TargetPositioning::backward);
  const ArrayXd values = figures(f, b);
  Stream stream(bootstrap.seed, name);
  ArrayXd sum = ArrayXd::Zero(values.size()), squares = sum;
  for (int k = 0; k < bootstrap.replicas; ++k) {
    const Side again_f = Again(f, stream), again_b = Again(b, stream);
    const ArrayXd change = figures(again_f, again_b) - values;
    sum += change;
    squares += change.square();
  }
  const double n = bootstrap.replicas;
  const ArrayXd bias = sum / n, u = (squares / n - bias.square()).abs().sqrt();  // rounding may give -0
  std::vector<ScatteredValue> scattered;
  for (Eigen::Index i = 0; i < values.size(); ++i) scattered.push_back({values[i], u[i], bias[i]});
  return scattered;
}

}  // namespace twinbench::measure
