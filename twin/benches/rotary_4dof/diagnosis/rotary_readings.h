#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "twin/benches/rotary_4dof/estimators/geometry.h"
#include "twin/core/reading.h"
#include "twin/core/scenario.h"

/// What the readings of the rotary bench say before any model is fitted.
namespace twinbench::diagnose::rotary {

/// True if the reading has four voltages, its angles, and in the calibration phase the autocollimator's.
bool IsUsable(const Reading& reading);

/// The four channels referred to the PSDs' surfaces, by row [m].
Eigen::VectorXd ObservedOf(const std::vector<Reading>& used, const measure::BenchGeometry& geometry);

/// What each row shows of the angles that the autocollimator saw [m / rad].
struct SweptSlopes {
  Eigen::VectorXd of_yaw, of_tilt;
};

/// The largest step to which the means of a channel are rounded, on its PSD; 0: none.
double RoundingStep_m(const std::vector<Reading>& used, const measure::BenchGeometry& geometry);

/// Standard uncertainty of each row [m]: the blocks' deviations pooled by channel, else what the scenario states;
/// in the calibration phase the autocollimator's as well.
Eigen::VectorXd SigmaOf(const std::vector<Reading>& used, const Scenario& scenario,
                        const measure::BenchGeometry& geometry, const SweptSlopes& swept);

/// Median deviation of one sample over all channels, else what the scenario states.
double SampleNoise_V(const std::vector<Reading>& used, const Scenario& scenario);

/// Real samples always scatter; only a simulation states deviations of nothing.
bool IsNoiseFree(const std::vector<Reading>& used);

}  // namespace twinbench::diagnose::rotary
