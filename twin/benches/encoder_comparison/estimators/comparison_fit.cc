#include "twin/benches/encoder_comparison/estimators/comparison_fit.h"
#include "twin/separate/mean.h"

#include <algorithm>
#include <cmath>


namespace twinbench::separate::encoder {
namespace {

constexpr int kRounds = 4;  // of 1e-2 each

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

ScaleAngles AnglesOf(const PassGroup& group, double mounting_rad, const harmonics::HarmonicSeries& reference) {
  ScaleAngles th_rad;
  for (const ComparedPass& pass : group.passes) {
    Eigen::VectorXd th = pass.reference_rad;
    for (double& angle : th) angle += mounting_rad - ValueAt(reference, angle);
    th_rad.push_back(th);
  }
  return th_rad;
}

harmonics::PositionError SeenBy(const FittedGroup& fitted, const OrderNoise& noise, double mounting_rad) {
  harmonics::PositionError seen;
  seen.setup = fitted.group->setup;
  seen.direction = fitted.group->direction;
  seen.head_rad = mounting_rad;
  seen.status = harmonics::PositionStatus::kOk;
  seen.series.dof = noise.dof;
  for (int k = 0; k < fitted.fit.Highest(); ++k)
    seen.series.orders.push_back(
        {fitted.fit.value[k], noise.variance_rad2[k] * fitted.fit.cofactor[static_cast<std::size_t>(k)]});
  return seen;
}

FitRest RestOf(const std::vector<FittedGroup>& groups, const OrderNoise& noise, const DeviceOptions& options) {
  const double pooled = noise.between_laps ? 2.0 * options.pooled_orders + 1.0 : 1.0;
  FitRest rest{.visible = (DistinctAngles(groups.front().th_rad) - 1) / 2,
               .of_lines = options.of_lines,
               .white_rad2 = noise.white_rad2,
               .noise_dof = pooled * noise.dof,
               .step_rad = options.steps.step_rad};
  for (const FittedGroup& group : groups) {
    rest.th_rad.insert(rest.th_rad.end(), group.th_rad.begin(), group.th_rad.end());
    rest.rest_rad.insert(rest.rest_rad.end(), group.fit.rest_rad.begin(), group.fit.rest_rad.end());
    rest.visible = std::min(rest.visible, (DistinctAngles(group.th_rad) - 1) / 2);
  }
  return rest;
}

}  // namespace

UsableGroups PickUsable(const std::vector<PassGroup>& groups, const DeviceOptions& options) {
  const std::map<int, double> mounting_rad = RoughMountings(groups);
  std::vector<int> highest;
  for (const PassGroup& group : groups)
    highest.push_back(HighestOrder(group, AnglesOf(group, mounting_rad.at(group.setup), {}), options.max_order,
                                   options.max_inflation));
  UsableGroups usable;
  if (groups.empty()) return usable;
  usable.highest = *std::ranges::max_element(highest);
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const bool poor = highest[g] == 0 || 2 * highest[g] < *std::ranges::max_element(highest);
    (poor ? usable.poor : usable.used).push_back(groups[g]);
    if (!poor) usable.highest = std::min(usable.highest, highest[g]);
  }
  return usable;
}

ComparisonFit FitComparison(const UsableGroups& groups, const DeviceOptions& options) {
  ComparisonFit fitted;
  fitted.mounting_rad = RoughMountings(groups.used);
  for (int round = 0; round < kRounds; ++round) {
    fitted.groups.clear();
    for (const PassGroup& group : groups.used) {
      ScaleAngles th_rad = AnglesOf(group, fitted.mounting_rad.at(group.setup), fitted.curves.reference);
      CurveFit fit = FitCurve(group, th_rad, groups.highest);
      fitted.groups.push_back({&group, std::move(th_rad), std::move(fit)});
    }
    fitted.mounting_rad = MountingsOf(fitted.groups);
    fitted.noise = NoiseOf(fitted.groups, groups.highest, options.pooled_orders);
    fitted.rounding = RoundingIn(fitted.groups, fitted.noise, groups.highest, options.steps);
    std::vector<harmonics::PositionError> seen;
    for (const FittedGroup& group : fitted.groups)
      seen.push_back(SeenBy(group, fitted.noise, fitted.mounting_rad.at(group.group->setup)));
    fitted.curves = SeparateMountings(seen, options.max_noise_factor, fitted.rounding);
    if (round + 1 < kRounds) continue;
    fitted.unresolved = UnresolvedBy(fitted.curves.device, RestOf(fitted.groups, fitted.noise, options));
    fitted.rounding.AddFolded(fitted.groups, fitted.unresolved);
    fitted.curves = SeparateMountings(seen, options.max_noise_factor, fitted.rounding);
    for (harmonics::HarmonicSeries* series :
         {&fitted.curves.device, &fitted.curves.forward, &fitted.curves.backward})
      series->unresolved_rad2 = fitted.unresolved.Variance_rad2();
  }
  return fitted;
}

}  // namespace twinbench::separate::encoder
