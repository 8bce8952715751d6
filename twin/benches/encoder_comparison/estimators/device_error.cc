#include "twin/benches/encoder_comparison/estimators/device_error.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace twinbench::separate::encoder {
namespace {

constexpr int kParts = 360;        // of a turn: degrees
constexpr double kOffCount = 0.5;  // turns a turn: no error of a device, but its gear or its sense of rotation

void FillPasses(const ComparisonFit& fitted, DeviceError& result) {
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

/// Weighted mean over the groups.
void FillLag(const ComparisonFit& fitted, DeviceError& result) {
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

/// Of the groups together.
void FillShares(const ComparisonFit& fitted, DeviceError& result) {
  for (std::size_t k = 0; k < static_cast<std::size_t>(fitted.noise.variance_rad2.size()); ++k) {
    const double scatter_rad2 = fitted.noise.variance_rad2[static_cast<Eigen::Index>(k)];
    double scatter = 0.0, rounding = 0.0, folded = 0.0;
    for (std::size_t g = 0; g < fitted.groups.size(); ++g) {
      scatter += scatter_rad2 * fitted.groups[g].fit.cofactor[k].trace();
      rounding += fitted.rounding.StepsBetween(g, g, static_cast<int>(k) + 1).trace();
      folded += fitted.rounding.FoldedBetween(g, g, static_cast<int>(k) + 1).trace();
    }
    const auto share = [all = scatter + rounding + folded](double part) { return part > 0.0 ? part / all : 0.0; };
    result.rounding_share.push_back(share(rounding));
    result.folded_share.push_back(share(folded));
    result.white_share.push_back((1.0 - share(rounding) - share(folded)) *
                                 std::min(1.0, fitted.noise.white_rad2 / scatter_rad2));
  }
}

std::string List(const std::vector<int>& orders) {
  std::string text;
  for (const int order : orders) text += fmt::format("{}{}", text.empty() ? "" : ", ", order);
  return text;
}

void AddNotes(const UsableGroups& groups, const ComparisonFit& fitted, DeviceError& result) {
  for (const PassGroup& group : groups.poor)
    result.notes.push_back(fmt::format("mounting {}, direction {:+d}: too small a part of the turn, not used",
                                       group.setup, group.direction));
  if (!fitted.noise.between_laps)
    result.notes.push_back("no direction of a mounting has two turns: uncertainties suppose white noise");
  if (std::ranges::any_of(result.passes, [](const PassResult& p) { return std::isnan(p.slope_rad_per_turn); }))
    result.notes.push_back(
        "a pass of less than one and a half turns does not tell drift or a wrong scale from the curve");
  if (result.low_order_scatter > 2.0)
    result.notes.push_back(
        fmt::format("order 1 scatters {:.1f} times more between turns than white noise would: drift",
                    result.low_order_scatter));
  if (!fitted.curves.disagreeing.empty())
    result.notes.push_back("the mountings contradict each other in order " + List(fitted.curves.disagreeing) +
                           ": an error that changed with the mounting; its uncertainty is widened");
}

void AddNotesOfLines(const Unresolved& unresolved, DeviceError& result) {
  std::vector<int> folded;
  for (const auto& [order, square_rad2] : unresolved.lines) folded.push_back(order);
  if (!folded.empty())
    result.notes.push_back(
        "these measuring positions do not tell orders of lines, teeth or signals from lower ones: " + List(folded) +
        "; u holds that they may be either");
  if (!unresolved.hidden.empty())
    result.notes.push_back(
        "orders of lines, teeth or signals err alike at all measuring positions and are in no u: " +
        List(unresolved.hidden));
}

/// Turns of the device for one of the reference, by a line through each pass.
double TurnsOfDevice(const std::vector<PassGroup>& groups) {
  double product = 0.0, square = 0.0;
  for (const PassGroup& group : groups) {
    for (const ComparedPass& pass : group.passes) {
      const Eigen::ArrayXd way_rad = pass.reference_rad.array() - pass.reference_rad.mean();
      product += (way_rad * pass.error_rad.array()).sum();
      square += way_rad.square().sum();
    }
  }
  return square > 0.0 ? 1.0 + product / square : 1.0;
}

/// Why there is no curve; empty: there is one.
std::string Obstacle(const std::vector<PassGroup>& groups, int highest_order) {
  if (groups.empty()) return "no reading has both angles and a direction";
  const double turns = TurnsOfDevice(groups);
  if (std::abs(turns - 1.0) > kOffCount)
    return fmt::format("measured goes through {:.3g} turns for one turn of the reference", turns);
  return highest_order == 0 ? "no mounting has a complete turn in one direction" : "";
}

}  // namespace

DeviceError SeparateDevice(const std::vector<Reading>& readings, const DeviceOptions& options) {
  const SortedPasses sorted = SortPasses(readings);
  DeviceError result;
  result.left_out = sorted.left_out;
  result.used = static_cast<int>(readings.size()) - sorted.left_out;
  const UsableGroups groups = PickUsable(sorted.groups, options);
  result.not_separated = Obstacle(sorted.groups, groups.highest);
  if (!result.not_separated.empty()) return result;
  DeviceOptions with_steps = options;
  with_steps.steps = WithOwnStep(options.steps, readings);
  const ComparisonFit fitted = FitComparison(groups, with_steps);
  result.highest_order = groups.highest;
  result.curves = fitted.curves;
  for (const auto& [setup, mounting_rad] : fitted.mounting_rad) result.mounting_rad.push_back(mounting_rad);
  FillPasses(fitted, result);
  result.reversal = ReversalOf(fitted);
  result.both = MeansOf(fitted, 0, kParts);
  result.forward = MeansOf(fitted, 1, kParts);
  result.backward = MeansOf(fitted, -1, kParts);
  FillLag(fitted, result);
  result.residual_rms_rad = std::sqrt(fitted.noise.white_rad2);
  result.low_order_scatter = std::sqrt(fitted.noise.variance_rad2[0] / fitted.noise.white_rad2);
  FillShares(fitted, result);
  result.dof = 0.0;
  for (const FittedGroup& group : fitted.groups) result.dof += group.fit.dof;
  AddNotes(groups, fitted, result);
  AddNotesOfLines(fitted.unresolved, result);
  return result;
}

harmonics::HarmonicSeries OfShare(harmonics::HarmonicSeries series, const std::vector<double>& share) {
  series.unresolved_rad2 = 0.0;
  for (int k = 1; k <= series.Highest(); ++k) series.At(k).cov *= share.at(static_cast<std::size_t>(k - 1));
  return series;
}

CurveAt Curve(const harmonics::HarmonicSeries& series, int points) {
  return {harmonics::Resample(series, points), harmonics::ResampledUncertainty(series, points)};
}

}  // namespace twinbench::separate::encoder
