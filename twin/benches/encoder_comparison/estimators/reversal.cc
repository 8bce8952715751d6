#include "twin/benches/encoder_comparison/estimators/reversal.h"
#include "twin/separate/mean.h"

#include <algorithm>
#include <cmath>


namespace twinbench::separate::encoder {
namespace {

/// Variance of one pass's constant from their scatter, all groups together; NaN if none has two passes.
double ConstantVariance(const ComparisonFit& fitted) {
  double squares = 0.0, dof = 0.0;
  for (const FittedGroup& group : fitted.groups) {
    Mean constant;
    for (const PassTerm& pass : group.fit.passes) constant.Add(pass.constant_rad);
    for (const PassTerm& pass : group.fit.passes) squares += std::pow(pass.constant_rad - constant.Value(), 2);
    dof += constant.count - 1.0;
  }
  return dof > 0.0 ? squares / dof : kNaN;
}

struct SetUpReversal {
  double forward_rad = kNaN, backward_rad = kNaN;
  double variance = 0.0, white = 0.0, rounding = 0.0;  // all of it; what white noise makes, what steps repeat
};

std::map<int, SetUpReversal> ReversalsOf(const ComparisonFit& fitted) {
  const double variance = ConstantVariance(fitted);
  std::map<int, SetUpReversal> reversals;
  for (std::size_t g = 0; g < fitted.groups.size(); ++g) {
    const FittedGroup& group = fitted.groups[g];
    Mean constant;
    for (const PassTerm& pass : group.fit.passes) constant.Add(pass.constant_rad);
    SetUpReversal& reversal = reversals[group.group->setup];
    (group.group->direction > 0 ? reversal.forward_rad : reversal.backward_rad) = constant.Value();
    const double white = fitted.noise.white_rad2 * group.fit.constant_cofactor;
    reversal.rounding += fitted.rounding.groups[g].mean_rad2;
    reversal.variance += std::max(variance / constant.count, white) + fitted.rounding.groups[g].mean_rad2;
    reversal.white += white;
  }
  return reversals;
}

}  // namespace

MeanReversal ReversalOf(const ComparisonFit& fitted) {
  Mean reversal;
  double variance = 0.0, white = 0.0, rounding = 0.0;
  for (const auto& [setup, r] : ReversalsOf(fitted)) {
    const double difference_rad = r.forward_rad - r.backward_rad;
    if (!std::isfinite(difference_rad)) continue;
    reversal.Add(difference_rad);
    variance += r.variance;
    white += r.white;
    rounding += r.rounding;
  }
  if (reversal.count == 0) return {};
  return {reversal.Value(), std::sqrt(variance) / reversal.count, white / variance, rounding / variance};
}

}  // namespace twinbench::separate::encoder
