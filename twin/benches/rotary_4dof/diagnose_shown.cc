#include <algorithm>
#include <cmath>
#include <memory>

#include "twin/benches/rotary_4dof/diagnose.h"
#include "twin/benches/rotary_4dof/estimators/calibrate.h"
#include "twin/benches/rotary_4dof/estimators/grating_model.h"
#include "twin/benches/rotary_4dof/estimators/published_motion.h"
#include "twin/benches/rotary_4dof/settings.h"
#include "twin/benches/rotary_4dof/twin/factory.h"
#include "twin/core/distributions.h"
#include "twin/core/linear_algebra.h"
#include "twin/core/rounding.h"
#include "twin/diagnose/products.h"

namespace twinbench::benches::rotary {
namespace {

/// Where the published equations have the spots of a motion: they are solved for it by Newton's method.
Eigen::Vector4d PublishedSpots_m(const Eigen::Vector4d& motion, Eigen::Vector4d spots_m,
                                 const measure::BenchGeometry& geometry) {
  constexpr int kIterations = 4;  // from the exact spots, some percent off
  constexpr double kStep_m = 1e-7;
  const double l1_m = 0.5 * (geometry.psd_distance_m[0] + geometry.psd_distance_m[1]);
  const auto told = [&](const Eigen::Vector4d& at_m) { return measure::PublishedMotion(at_m, l1_m, geometry); };
  for (int k = 0; k < kIterations; ++k) {
    Eigen::Matrix4d slopes;
    for (int c = 0; c < kChannels; ++c) {
      const Eigen::Vector4d step_m = kStep_m * Eigen::Vector4d::Unit(c);
      slopes.col(c) = (told(spots_m + step_m) - told(spots_m - step_m)) / (2.0 * kStep_m);
    }
    spots_m -= SolveFour(slopes, told(spots_m) - motion);
  }
  return spots_m;
}

class OnPsds : public model::Follow {
 public:
  /// @param bare  Without effects, where its light gives way to the published equations; null: it does not.
  OnPsds(std::unique_ptr<model::Follow> twin, std::unique_ptr<model::Follow> bare,
         const measure::BenchGeometry& geometry)
      : twin_(std::move(twin)), bare_(std::move(bare)), geometry_(geometry) {}

  const std::vector<model::Point>& Points() const override { return twin_->Points(); }
  Eigen::Index Readings() const override { return twin_->Readings(); }
  Eigen::MatrixXd Predict(const std::vector<model::Disturbance>& at) const override {
    Eigen::MatrixXd shown_m = Shown_m(*twin_, at);
    if (!bare_) return shown_m;
    const Eigen::MatrixXd bare_m = Shown_m(*bare_, at);
    for (Eigen::Index i = 0; i < shown_m.rows(); ++i) {
      const Eigen::Vector4d exact_m = bare_m.row(i);
      const Eigen::Vector4d motion = measure::SolveMotion(exact_m, geometry_).motion;
      shown_m.row(i) += PublishedSpots_m(motion, exact_m, geometry_) - exact_m;
    }
    return shown_m;
  }
  std::vector<std::string> Unfixed() const override { return twin_->Unfixed(); }

 private:
  Eigen::MatrixXd Shown_m(const model::Follow& twin, const std::vector<model::Disturbance>& at) const {
    const auto& [a_V_m, b_V_m] = geometry_.sensitivity_V_m;
    return twin.Predict(at) * Eigen::Vector4d(a_V_m, a_V_m, b_V_m, b_V_m).cwiseInverse().asDiagonal();
  }

  std::unique_ptr<model::Follow> twin_, bare_;
  measure::BenchGeometry geometry_;
};

Scenario WithoutEffects(Scenario scenario) {
  scenario.effects.clear();
  scenario.empiricals.clear();
  return scenario;
}

/// Of means that were written down with few digits, or taken by a converter coarser than their noise: each channel.
Eigen::Vector4d RoundingSteps_m(const std::vector<Reading>& used, const measure::BenchGeometry& geometry) {
  Eigen::Vector4d steps_m;
  for (std::size_t c = 0; c < kChannels; ++c) {
    const auto V = [c](const Reading& r) { return r.mean_V[c]; };
    steps_m[static_cast<Eigen::Index>(c)] =
        CommonStep(diagnose::OfReadings(used, V)) / geometry.sensitivity_V_m[c / 2];
  }
  return steps_m;
}

/// Stated standard uncertainty of a mean on each channel: pooled over all blocks, else from the scenario.
Eigen::Vector4d BlockNoise_m(const std::vector<Reading>& used, const Scenario& scenario,
                             const measure::BenchGeometry& geometry) {
  Eigen::Vector4d sum_m2 = Eigen::Vector4d::Zero();
  int count = 0;
  for (const Reading& r : used) {
    const auto variances_m2 = measure::SpotVariances(r, geometry);
    if (!variances_m2) continue;
    sum_m2 += *variances_m2;
    ++count;
  }
  if (2 * count > std::ssize(used)) return (sum_m2 / count).cwiseSqrt();
  const RotarySettings& own = RotaryOf(scenario);
  const double mean_V = std::hypot(own.amplifier.noise_V, geometry.adc_step_V / std::sqrt(12.0)) /
                        std::sqrt(own.adc.samples);
  const auto& [a_V_m, b_V_m] = geometry.sensitivity_V_m;
  return {mean_V / a_V_m, mean_V / a_V_m, mean_V / b_V_m, mean_V / b_V_m};
}

}  // namespace

model::FollowMaker FollowOnPsds(bool published) {
  return [follow = FollowOften(), published](const Scenario& scenario, const std::vector<Reading>& record) {
    std::unique_ptr<model::Follow> bare;
    if (published) bare = follow(WithoutEffects(scenario), record);
    return std::make_unique<OnPsds>(follow(scenario, record), std::move(bare), measure::NominalGeometry(scenario));
  };
}

void StateNoise(const std::vector<Reading>& used, const Scenario& scenario,
                diagnose::TwinComparison& comparison) {
  const measure::BenchGeometry geometry = measure::NominalGeometry(scenario);
  const Eigen::Vector4d steps_m = RoundingSteps_m(used, geometry);
  const Eigen::Vector4d noise_m =
      (BlockNoise_m(used, scenario, geometry).cwiseAbs2() + steps_m.cwiseAbs2() / 12.0).cwiseSqrt();
  comparison.rounding = steps_m.maxCoeff();
  comparison.noise_of = [noise_m](const Scenario&, const Reading&) -> Eigen::VectorXd { return noise_m; };
  comparison.scatter = [sweep_rad = geometry.autocollimator_noise_rad](const Scenario& believed) {
    std::vector<diagnose::TwinComparison::Scatter> scatter = {{"mount.ez", sweep_rad, IsInCalibration},
                                                              {"mount.ex", sweep_rad, IsInCalibration}};
    const RotarySettings& own = RotaryOf(believed);
    for (const auto& table : {diagnose::RepeatabilityOf("target", own.target.repeatability_sd),
                              diagnose::RepeatabilityOf("reference", own.reference.repeatability_sd)})
      scatter.insert(scatter.end(), table.begin(), table.end());
    return scatter;
  };
}

bool IsInCalibration(const Reading& r) {
  return r.phase == Phase::kCalibration;
}

double SampleNoise_V(const std::vector<Reading>& used, const Scenario& scenario) {
  std::vector<double> stds_V;
  for (const Reading& r : used)
    std::ranges::copy_if(r.std_V, std::back_inserter(stds_V), [](double V) { return std::isfinite(V); });
  return stds_V.empty() ? RotaryOf(scenario).amplifier.noise_V : Median(std::move(stds_V));
}

bool IsNoiseFree(const std::vector<Reading>& used) {
  return std::ranges::all_of(
      used, [](const Reading& r) { return std::ranges::all_of(r.std_V, [](double V) { return V == 0.0; }); });
}

}  // namespace twinbench::benches::rotary
