#include "twin/benches/encoder_comparison/estimators/iso230_2.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "twin/core/errors.h"
#include "twin/core/stream.h"

namespace twinbench::measure {
namespace {

using Eigen::ArrayXd;
constexpr auto kNaNWins = Eigen::PropagateNaN;  // one value that is not available makes the largest not available

/// All targets from one side, one entry a target; NaN where runs are too few.
struct Side {
  ArrayXd runs, mean, deviation;

  ArrayXd Low() const { return mean - 2.0 * deviation; }
  ArrayXd High() const { return mean + 2.0 * deviation; }
};

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

ApproachPositioning Summarise(const std::vector<double>& runs) {
  ApproachPositioning a;
  a.runs = static_cast<int>(runs.size());
  if (runs.empty()) return a;
  const Eigen::Map<const ArrayXd> x(runs.data(), std::ssize(runs));
  Require(x.isFinite().all(), "positioning: a deviation is not finite");
  a.mean = x.mean();
  if (a.runs < 2) return a;
  const double freedom = a.runs - 1.0;
  a.deviation = std::sqrt((x - a.mean).square().sum() / freedom);
  a.u_mean = a.deviation / std::sqrt(a.runs);
  a.u_deviation = a.deviation / std::sqrt(2.0 * freedom);
  return a;
}

TargetPositioning Summarise(const PositioningTarget& target) {
  TargetPositioning t;
  t.position = target.position;
  t.forward = Summarise(target.forward);
  t.backward = Summarise(target.backward);
  t.mean = 0.5 * (t.forward.mean + t.backward.mean);
  t.reversal = t.forward.mean - t.backward.mean;
  t.u_reversal = std::hypot(t.forward.u_mean, t.backward.u_mean);
  t.u_mean = 0.5 * t.u_reversal;
  return t;
}

Side SideOf(const std::vector<TargetPositioning>& targets, ApproachPositioning TargetPositioning::*approach) {
  const Eigen::Index size = std::ssize(targets);
  Side side{ArrayXd(size), ArrayXd(size), ArrayXd(size)};
  for (Eigen::Index i = 0; i < size; ++i) {
    const ApproachPositioning& a = targets[static_cast<std::size_t>(i)].*approach;
    side.runs[i] = a.runs;
    side.mean[i] = a.mean;
    side.deviation[i] = a.deviation;
  }
  return side;
}

/// What the same number of runs could have given: mean normal, variance chi-squared.
Side Again(const Side& side, Stream& stream) {
  Side again = side;
  for (Eigen::Index i = 0; i < side.mean.size(); ++i) {
    const double freedom = side.runs[i] - 1.0;
    const double chi_squared = freedom > 0.0 ? stream.ChiSquared(freedom) : kNaN;
    again.mean[i] += side.deviation[i] / std::sqrt(side.runs[i]) * stream.Normal();
    again.deviation[i] *= std::sqrt(chi_squared / freedom);
  }
  return again;
}

std::vector<ScatteredValue> WithScatter(const Side& f, const Side& b, const PositioningBootstrap& bootstrap) {
  const ArrayXd values = Characteristics(f, b);
  Stream stream(bootstrap.seed, "iso230_2.bootstrap");
  ArrayXd sum = ArrayXd::Zero(values.size()), squares = sum;
  for (int k = 0; k < bootstrap.replicas; ++k) {
    const Side again_f = Again(f, stream), again_b = Again(b, stream);
    const ArrayXd change = Characteristics(again_f, again_b) - values;
    sum += change;
    squares += change.square();
  }
  const double n = bootstrap.replicas;
  const ArrayXd bias = sum / n, u = (squares / n - bias.square()).abs().sqrt();  // rounding may give -0
  std::vector<ScatteredValue> scattered;
  for (Eigen::Index i = 0; i < values.size(); ++i) scattered.push_back({values[i], u[i], bias[i]});
  return scattered;
}

}  // namespace

AxisPositioning EvaluatePositioning(const std::vector<PositioningTarget>& targets,
                                    const PositioningBootstrap& bootstrap) {
  AxisPositioning result;
  if (targets.empty()) return result;
  for (const PositioningTarget& target : targets) result.targets.push_back(Summarise(target));
  const Side forward = SideOf(result.targets, &TargetPositioning::forward);
  const Side backward = SideOf(result.targets, &TargetPositioning::backward);
  const std::vector<ScatteredValue> values = WithScatter(forward, backward, bootstrap);
  std::copy_n(values.begin(), kAxisValues, result.axis.begin());
  for (std::size_t i = 0; i < targets.size(); ++i) result.targets[i].repeatability = values[kAxisValues + i];
  return result;
}

}  // namespace twinbench::measure
