#include "twin/benches/encoder_comparison/estimators/iso230_2.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "twin/benches/encoder_comparison/estimators/positioning_scatter.h"
#include "twin/core/errors.h"
#include "twin/core/rounding.h"

namespace twinbench::measure {
namespace {

using Eigen::ArrayXd;
constexpr auto kNaNWins = Eigen::PropagateNaN;  // one value that is not available makes the largest not available

double LargestOf(const ArrayXd& values) {
  return values.maxCoeff<kNaNWins>();
}

double Span(const ArrayXd& low, const ArrayXd& high) {
  return high.maxCoeff<kNaNWins>() - low.minCoeff<kNaNWins>();
}

ArrayXd Both(const ArrayXd& forward, const ArrayXd& backward) {
  ArrayXd both(forward.size() + backward.size());
  both << forward, backward;
  return both;
}

/// R_i of both sides together. What is not available is not larger than anything, so it stays where it stands.
ArrayXd Repeatabilities(const Side& f, const Side& b) {
  const ArrayXd across = 2.0 * f.deviation + 2.0 * b.deviation + (f.mean - b.mean).abs();
  const ArrayXd along = 4.0 * (f.deviation > b.deviation).select(f.deviation, b.deviation);
  return (along > across).select(along, across);
}

/// The axis values in the order of AxisValue, behind them R_i of each target.
ArrayXd Characteristics(const Side& f, const Side& b) {
  const ArrayXd reversal = f.mean - b.mean, mean = 0.5 * (f.mean + b.mean), r = Repeatabilities(f, b);
  const ArrayXd means = Both(f.mean, b.mean);
  ArrayXd values(kAxisValues + r.size());
  values << LargestOf(reversal.abs()), reversal.mean(),                          // B, mean B
      4.0 * LargestOf(f.deviation), 4.0 * LargestOf(b.deviation), LargestOf(r),  // R+, R-, R
      Span(f.mean, f.mean), Span(b.mean, b.mean), Span(means, means),            // E+, E-, E
      Span(mean, mean),                                                          // M
      Span(f.Low(), f.High()), Span(b.Low(), b.High()),                          // A+, A-
      Span(Both(f.Low(), b.Low()), Both(f.High(), b.High())), r;                 // A
  return values;
}

ApproachPositioning Summarise(const std::vector<double>& runs, const RunRounding& rounding) {
  ApproachPositioning a;
  a.rounding = rounding.repeated;
  a.runs = static_cast<int>(runs.size());
  if (runs.empty()) return a;
  const Eigen::Map<const ArrayXd> x(runs.data(), std::ssize(runs));
  Require(x.isFinite().all(), "positioning: a deviation is not finite");
  a.mean = x.mean();
  if (a.runs < 2) return a;
  const double freedom = a.runs - 1.0;
  a.deviation = std::sqrt((x - a.mean).square().sum() / freedom);
  a.u_mean = std::hypot(std::max(a.deviation, rounding.scattered) / std::sqrt(a.runs), rounding.repeated);
  a.u_deviation = std::hypot(a.deviation, rounding.repeated) / std::sqrt(2.0 * freedom);
  return a;
}

TargetPositioning Summarise(const PositioningTarget& target, const RunRounding& rounding) {
  TargetPositioning t;
  t.position = target.position;
  t.forward = Summarise(target.forward, rounding);
  t.backward = Summarise(target.backward, rounding);
  t.mean = 0.5 * (t.forward.mean + t.backward.mean);
  t.reversal = t.forward.mean - t.backward.mean;
  t.u_reversal = std::hypot(t.forward.u_mean, t.backward.u_mean);
  t.u_mean = 0.5 * t.u_reversal;
  return t;
}

/// Deviations of runs about their means, from one side of a target.
void AddScatter(const std::vector<double>& runs, double& squares, double& dof) {
  if (runs.size() < 2) return;
  const Eigen::Map<const ArrayXd> x(runs.data(), std::ssize(runs));
  squares += (x - x.mean()).square().sum();
  dof += static_cast<double>(runs.size()) - 1.0;
}

}  // namespace

RunRounding RoundingOfTargets(const std::vector<PositioningTarget>& targets, double step, double at_once) {
  if (!(step > 0.0)) return {};
  double squares = 0.0, dof = 0.0;
  for (const PositioningTarget& target : targets) {
    AddScatter(target.forward, squares, dof);
    AddScatter(target.backward, squares, dof);
  }
  const double noise = dof > 0.0 ? NoiseBehindRounding(step, std::sqrt(at_once * squares / dof)) : 0.0;
  const double repeated = RoundingOf(step, noise, INFINITY).repeated;
  return {std::sqrt(repeated), std::sqrt(std::max(0.0, step * step / 12.0 - repeated) / at_once)};
}

AxisPositioning EvaluatePositioning(const std::vector<PositioningTarget>& targets,
                                    const PositioningBootstrap& bootstrap, const RunRounding& rounding) {
  AxisPositioning result;
  if (targets.empty()) return result;
  for (const PositioningTarget& target : targets) result.targets.push_back(Summarise(target, rounding));
  const std::vector<ScatteredValue> values = WithScatter(result.targets, Characteristics, bootstrap, "iso230_2.bootstrap");
  std::copy_n(values.begin(), kAxisValues, result.axis.begin());
  for (std::size_t i = 0; i < targets.size(); ++i) result.targets[i].repeatability = values[kAxisValues + i];
  return result;
}

}  // namespace twinbench::measure
