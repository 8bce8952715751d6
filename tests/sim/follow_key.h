#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "tests/support/small_scenario.h"
#include "tests/support/twin_run.h"
#include "twin/benches/rotary_4dof/twin/follow.h"

namespace twinbench::sim {

/// Runs a small bench without noise before and after a change of it, and demands that the twin which follows the
/// records shows the same difference.
/// @param within_V   Of each reading's difference.
/// @param at_least_V What the change does to some reading: it does something.
inline void ExpectFollowed(Scenario scenario, const std::function<void(RotarySettings&)>& change, double within_V,
                           double at_least_V) {
  const test::TwinRun before = test::RunTwin(scenario);
  change(RotaryOf(scenario));
  const test::TwinRun after = test::RunTwin(scenario);
  const auto follow = [](const test::TwinRun& run) {
    return FollowRotary(run.scenario, run.readings, std::make_shared<DrivesOnce>())->Predict();
  };
  const Eigen::MatrixXd followed_V = follow(after) - follow(before);
  double most_V = 0.0;
  for (std::size_t i = 0; i < after.readings.size(); ++i) {
    for (int c = 0; c < kChannels; ++c) {
      const double shown_V = after.readings[i].mean_V[c] - before.readings[i].mean_V[c];
      EXPECT_NEAR(followed_V(static_cast<Eigen::Index>(i), c), shown_V, within_V) << "reading " << i;
      most_V = std::max(most_V, std::abs(shown_V));
    }
  }
  EXPECT_GT(most_V, at_least_V);
}

}  // namespace twinbench::sim
