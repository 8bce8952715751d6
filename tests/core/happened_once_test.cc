#include "twin/core/happened_once.h"

#include <gtest/gtest.h>

namespace twinbench {
namespace {

EffectSettings Effect(const std::string& name, const std::map<std::string, double>& parameters) {
  EffectSettings effect;
  effect.name = name;
  effect.parameters = parameters;
  return effect;
}

TEST(HappenedOnce, IsThereInItsRunStaysInLaterOnesAndIsNotYetInEarlierOnes) {
  Scenario scenario;
  scenario.repeat = 2;
  scenario.effects = {Effect("slip", {{"step", 0.1}, {"at_reading", 40.0}}), Effect("drift", {{"rate", 0.2}})};
  EXPECT_EQ(InRun(scenario, 2).effects.front().parameters.at("at_reading"), 40.0);
  const Scenario later = InRun(scenario, 3), earlier = InRun(scenario, 0);
  EXPECT_EQ(later.repeat, 3);
  EXPECT_EQ(later.effects.front().parameters.at("at_reading"), 0.0);
  EXPECT_EQ(later.effects.front().parameters.at("step"), 0.1);
  ASSERT_EQ(earlier.effects.size(), 1u);
  EXPECT_EQ(earlier.effects.front().name, "drift");
}

}  // namespace
}  // namespace twinbench
