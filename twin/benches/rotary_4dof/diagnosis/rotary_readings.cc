#include "twin/benches/rotary_4dof/diagnosis/rotary_readings.h"

#include <algorithm>
#include <cmath>

#include "twin/benches/rotary_4dof/estimators/calibrate.h"
#include "twin/benches/rotary_4dof/settings.h"
#include "twin/core/distributions.h"
#include "twin/diagnose/engine/noise_estimate.h"

namespace twinbench::diagnose::rotary {
namespace {

/// Stated standard uncertainty of a mean on one channel: pooled over all blocks, else from the scenario.
double StatedSigma_m(const std::vector<Reading>& used, int channel, const Scenario& scenario,
                     const measure::BenchGeometry& geometry) {
  double sum_m2 = 0.0;
  int count = 0;
  for (const Reading& r : used) {
    const auto variances = measure::SpotVariances(r, geometry);
    if (!variances) continue;
    sum_m2 += (*variances)[channel];
    ++count;
  }
  if (2 * count > std::ssize(used)) return std::sqrt(sum_m2 / count);
  const double mean_V = std::hypot(RotaryOf(scenario).amplifier.noise_V / std::sqrt(RotaryOf(scenario).adc.samples),
                                   geometry.adc_step_V / std::sqrt(12.0 * RotaryOf(scenario).adc.samples));
  return mean_V / geometry.sensitivity_V_m[static_cast<std::size_t>(channel / 2)];
}

/// Of means that were written down with few digits, or taken by a converter coarser than their noise.
double RoundingStepOf_m(const std::vector<Reading>& used, int channel, const measure::BenchGeometry& geometry) {
  Eigen::VectorXd shown_V(std::ssize(used));
  for (std::size_t i = 0; i < used.size(); ++i)
    shown_V[static_cast<Eigen::Index>(i)] = used[i].mean_V[static_cast<std::size_t>(channel)];
  return CommonStep(shown_V) / geometry.sensitivity_V_m[static_cast<std::size_t>(channel / 2)];
}

}  // namespace

bool IsUsable(const Reading& r) {
  if (r.status != ReadingStatus::kOk) return false;
  if (r.phase != Phase::kCalibration && r.phase != Phase::kFullCircle) return false;
  const auto finite = [](double v) { return std::isfinite(v); };
  if (!std::all_of(r.mean_V.begin(), r.mean_V.end(), finite)) return false;
  if (r.phase == Phase::kFullCircle) return finite(r.target_rad) && finite(r.reference_rad);
  return finite(r.autocollimator_yaw_rad) && finite(r.autocollimator_tilt_rad);
}

Eigen::VectorXd ObservedOf(const std::vector<Reading>& used, const measure::BenchGeometry& geometry) {
  Eigen::VectorXd observed(kChannels * std::ssize(used));
  for (std::size_t i = 0; i < used.size(); ++i) {
    observed.segment<4>(kChannels * static_cast<Eigen::Index>(i)) = measure::OnSurface(used[i].mean_V, geometry);
  }
  return observed;
}

bool IsNoiseFree(const std::vector<Reading>& used) {
  return std::ranges::all_of(
      used, [](const Reading& r) { return std::ranges::all_of(r.std_V, [](double V) { return V == 0.0; }); });
}

double SampleNoise_V(const std::vector<Reading>& used, const Scenario& scenario) {
  std::vector<double> stds_V;
  for (const Reading& r : used) {
    for (const double V : r.std_V) {
      if (std::isfinite(V)) stds_V.push_back(V);
    }
  }
  if (stds_V.empty()) return RotaryOf(scenario).amplifier.noise_V;
  return Median(std::move(stds_V));
}

double RoundingStep_m(const std::vector<Reading>& used, const measure::BenchGeometry& geometry) {
  double largest_m = 0.0;
  for (int c = 0; c < kChannels; ++c) largest_m = std::max(largest_m, RoundingStepOf_m(used, c, geometry));
  return largest_m;
}

Eigen::VectorXd SigmaOf(const std::vector<Reading>& used, const Scenario& scenario,
                        const measure::BenchGeometry& geometry, const SweptSlopes& swept) {
  Eigen::Vector4d noise_m;
  for (int c = 0; c < kChannels; ++c)
    noise_m[c] = std::hypot(StatedSigma_m(used, c, scenario, geometry),
                            RoundingStepOf_m(used, c, geometry) / std::sqrt(12.0));
  const Eigen::VectorXd sweep_m =
      geometry.autocollimator_noise_rad * (swept.of_yaw.cwiseAbs2() + swept.of_tilt.cwiseAbs2()).cwiseSqrt();
  Eigen::VectorXd sigma(kChannels * std::ssize(used));
  for (std::size_t i = 0; i < used.size(); ++i) {
    const auto at = kChannels * static_cast<Eigen::Index>(i);
    const bool is_swept = used[i].phase == Phase::kCalibration;
    for (Eigen::Index c = 0; c < kChannels; ++c)
      sigma[at + c] = is_swept ? std::hypot(noise_m[c], sweep_m[at + c]) : noise_m[c];
  }
  return sigma;
}

}  // namespace twinbench::diagnose::rotary
