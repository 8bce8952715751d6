#include "twin/separate/encoder/device_error.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "twin/core/units.h"
#include "twin/separate/encoder/lap_scatter.h"

namespace twinbench::separate::encoder {
namespace {

constexpr int kIterations = 4;  // each takes the rest down by slope of the curve x error of the other: 1e-2

struct Mean {
  double sum = 0.0;
  int count = 0;

  void Add(double value) {
    sum += value;
    ++count;
  }
  double Value() const { return sum / count; }
};

/// Re sum C_k exp(j k angle) over the orders that are known.
double ValueAt(const hob::HarmonicSeries& series, double angle_rad) {
  double value_rad = 0.0;
  for (int k = 1; k <= series.Highest(); ++k) {
    const hob::Complex c = series.At(k).value;
    if (std::isfinite(c.real())) value_rad += (c * std::polar(1.0, k * angle_rad)).real();
  }
  return value_rad;
}

/// Both directions count the same, whatever their passes.
std::map<int, double> MountingsOf(const std::vector<FittedGroup>& groups) {
  std::map<int, Mean> mean;
  for (const FittedGroup& fitted : groups) {
    Mean constant;
    for (const PassTerm& pass : fitted.fit.passes) constant.Add(pass.constant_rad);
    mean[fitted.group->setup].Add(constant.Value());
  }
  std::map<int, double> mountings;
  for (const auto& [setup, value] : mean) mountings[setup] = value.Value();
  return mountings;
}

std::map<int, double> RoughMountings(const std::vector<PassGroup>& groups) {
  std::map<int, Mean> mean;
  for (const PassGroup& group : groups) {
    for (const ComparedPass& pass : group.passes) mean[group.setup].Add(pass.error_rad.mean());
  }
  std::map<int, double> mountings;
  for (const auto& [setup, value] : mean) mountings[setup] = value.Value();
  return mountings;
}

ScaleAngles AnglesOf(const PassGroup& group, double mounting_rad, const hob::HarmonicSeries& reference) {
  ScaleAngles th_rad;
  for (const ComparedPass& pass : group.passes) {
    Eigen::VectorXd th = pass.reference_rad;
    for (double& angle : th) angle += mounting_rad - ValueAt(reference, angle);
    th_rad.push_back(th);
  }
  return th_rad;
}

hob::PositionError SeenBy(const FittedGroup& fitted, const OrderNoise& noise, double mounting_rad) {
  hob::PositionError seen;
  seen.setup = fitted.group->setup;
  seen.direction = fitted.group->direction;
  seen.head_rad = mounting_rad;
  seen.status = hob::PositionStatus::kOk;
  seen.series.dof = noise.dof;
  for (int k = 0; k < fitted.fit.Highest(); ++k)
    seen.series.orders.push_back(
        {fitted.fit.value[k], noise.variance_rad2[k] * fitted.fit.cofactor[static_cast<std::size_t>(k)]});
  return seen;
}

/// The groups with turns, and the order that all of them determine: no more than half of the best one's orders are given
/// up for a poor one.
class Groups {
 public:
  Groups(const std::vector<PassGroup>& all, const DeviceOptions& options) {
    const std::map<int, double> mounting_rad = RoughMountings(all);
    std::vector<int> highest;
    for (const PassGroup& group : all)
      highest.push_back(HighestOrder(group, AnglesOf(group, mounting_rad.at(group.setup), {}), options.max_order,
                                     options.max_inflation));
    const int best = highest.empty() ? 0 : *std::ranges::max_element(highest);
    highest_ = best;
    for (std::size_t g = 0; g < all.size(); ++g) {
      const bool poor = 2 * highest[g] < best || highest[g] == 0;
      (poor ? poor_ : used_).push_back(all[g]);
      if (!poor) highest_ = std::min(highest_, highest[g]);
    }
  }
  int highest() const { return highest_; }
  const std::vector<PassGroup>& used() const { return used_; }
  const std::vector<PassGroup>& poor() const { return poor_; }

 private:
  int highest_ = 0;
  std::vector<PassGroup> used_, poor_;
};

struct Fitted {
  std::vector<FittedGroup> groups;
  OrderNoise noise;
  std::map<int, double> mounting_rad;
  SeparatedCurves curves;
};

/// The angles need mounting and reference's error, which need the fit: a few rounds.
Fitted FitAll(const Groups& groups, const DeviceOptions& options) {
  Fitted fitted;
  fitted.mounting_rad = RoughMountings(groups.used());
  for (int round = 0; round < kIterations; ++round) {
    fitted.groups.clear();
    for (const PassGroup& group : groups.used()) {
      ScaleAngles th_rad = AnglesOf(group, fitted.mounting_rad.at(group.setup), fitted.curves.reference);
      CurveFit fit = FitCurve(group, th_rad, groups.highest());
      fitted.groups.push_back({&group, std::move(th_rad), std::move(fit)});
    }
    fitted.mounting_rad = MountingsOf(fitted.groups);
    fitted.noise = NoiseOf(fitted.groups, groups.highest(), options.pooled_orders);
    std::vector<hob::PositionError> seen;
    for (const FittedGroup& group : fitted.groups)
      seen.push_back(SeenBy(group, fitted.noise, fitted.mounting_rad.at(group.group->setup)));
    fitted.curves = SeparateMountings(seen, options.max_noise_factor);
  }
  return fitted;
}

void FillPasses(const Fitted& fitted, DeviceError& result) {
  for (const FittedGroup& group : fitted.groups) {
    for (std::size_t p = 0; p < group.fit.passes.size(); ++p) {
      const ComparedPass& pass = group.group->passes[p];
      const PassTerm& term = group.fit.passes[p];
      result.passes.push_back({group.group->setup, pass.pass, pass.direction,
                               static_cast<int>(pass.reference_rad.size()), pass.Turns(), term.constant_rad,
                               term.slope_rad_per_turn});
    }
  }
  std::ranges::sort(result.passes, {}, [](const PassResult& p) { return std::pair(p.setup, p.pass); });
}

/// Variance of one pass's constant from their scatter, all groups together; NaN if none has two passes.
double ConstantVariance(const Fitted& fitted) {
  double squares = 0.0, dof = 0.0;
  for (const FittedGroup& group : fitted.groups) {
    Mean constant;
    for (const PassTerm& pass : group.fit.passes) constant.Add(pass.constant_rad);
    for (const PassTerm& pass : group.fit.passes) squares += std::pow(pass.constant_rad - constant.Value(), 2);
    dof += constant.count - 1.0;
  }
  return dof > 0.0 ? squares / dof : kNaN;
}

struct Reversal {
  double forward_rad = kNaN, backward_rad = kNaN;
  double variance = 0.0;
};

/// By set-up. A mean is not better than the noise of its readings lets it be, even if two passes agree by chance.
std::map<int, Reversal> ReversalsOf(const Fitted& fitted) {
  const double variance = ConstantVariance(fitted);
  std::map<int, Reversal> reversals;
  for (const FittedGroup& group : fitted.groups) {
    Mean constant;
    for (const PassTerm& pass : group.fit.passes) constant.Add(pass.constant_rad);
    Reversal& reversal = reversals[group.group->setup];
    (group.group->direction > 0 ? reversal.forward_rad : reversal.backward_rad) = constant.Value();
    reversal.variance += std::max(variance / constant.count, fitted.noise.white_rad2 * group.fit.constant_cofactor);
  }
  return reversals;
}

void FillReversal(const Fitted& fitted, DeviceError& result) {
  Mean reversal;
  double variance = 0.0;
  for (const auto& [setup, r] : ReversalsOf(fitted)) {
    const double difference_rad = r.forward_rad - r.backward_rad;
    if (!std::isfinite(difference_rad)) continue;
    reversal.Add(difference_rad);
    variance += r.variance;
  }
  if (reversal.count == 0) return;
  result.reversal_rad = reversal.Value();
  result.u_reversal_rad = std::sqrt(variance) / reversal.count;
}

/// Weighted mean over the groups.
void FillLag(const Fitted& fitted, DeviceError& result) {
  double weight = 0.0, sum = 0.0;
  for (const FittedGroup& group : fitted.groups) {
    if (!std::isfinite(group.fit.lag_s)) continue;
    weight += 1.0 / group.fit.lag_cofactor;
    sum += group.fit.lag_s / group.fit.lag_cofactor;
  }
  if (weight == 0.0) return;
  result.lag_s = sum / weight;
  result.u_lag_s = std::sqrt(fitted.noise.white_rad2 / weight);
}

std::string List(const std::vector<int>& orders) {
  std::string text;
  for (const int order : orders) text += fmt::format("{}{}", text.empty() ? "" : ", ", order);
  return text;
}

void AddNotes(const Groups& groups, const Fitted& fitted, DeviceError& result) {
  for (const PassGroup& group : groups.poor())
    result.notes.push_back(fmt::format("set-up {}, direction {:+d}: too small a part of the turn, not used",
                                       group.setup, group.direction));
  if (!fitted.noise.between_laps)
    result.notes.push_back("no direction of a set-up has two turns: uncertainties suppose white noise");
  if (std::ranges::any_of(result.passes, [](const PassResult& p) { return std::isnan(p.slope_rad_per_turn); }))
    result.notes.push_back("a pass of less than one and a half turns does not tell drift or a wrong scale from the curve");
  if (result.low_order_scatter > 2.0)
    result.notes.push_back(fmt::format("order 1 scatters {:.1f} times more between turns than white noise would: drift",
                                       result.low_order_scatter));
  if (!fitted.curves.disagreeing.empty())
    result.notes.push_back("the mountings contradict each other in order " + List(fitted.curves.disagreeing) +
                           ": an error that changed with the mounting; its uncertainty is widened");
}

}  // namespace

DeviceError SeparateDevice(const std::vector<Reading>& readings, const DeviceOptions& options) {
  const SortedPasses sorted = SortPasses(readings);
  DeviceError result;
  result.left_out = sorted.left_out;
  result.used = static_cast<int>(readings.size()) - sorted.left_out;
  const Groups groups(sorted.groups, options);
  if (groups.highest() == 0) {
    result.not_separated = "no set-up has a complete turn in one direction";
    return result;
  }
  const Fitted fitted = FitAll(groups, options);
  result.highest_order = groups.highest();
  result.curves = fitted.curves;
  for (const auto& [setup, mounting_rad] : fitted.mounting_rad) result.mounting_rad.push_back(mounting_rad);
  FillPasses(fitted, result);
  FillReversal(fitted, result);
  FillLag(fitted, result);
  result.residual_rms_rad = std::sqrt(fitted.noise.white_rad2);
  result.low_order_scatter = std::sqrt(fitted.noise.variance_rad2[0] / fitted.noise.white_rad2);
  result.dof = 0.0;
  for (const FittedGroup& group : fitted.groups) result.dof += group.fit.dof;
  AddNotes(groups, fitted, result);
  return result;
}

CurveAt Curve(const hob::HarmonicSeries& series, int points) {
  return {hob::Resample(series, points), hob::ResampledUncertainty(series, points)};
}

}  // namespace twinbench::separate::encoder
