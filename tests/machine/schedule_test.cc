#include <gtest/gtest.h>

#include "tests/machine/benches.h"
#include "twin/benches/circular_motion/procedure.h"
#include "twin/benches/freeform_five_axis/procedure.h"

/// When readings of benches with a machine are due.
namespace twinbench::test {
namespace {

double Between_s(const Reading& one, const Reading& other) {
  return ToSeconds(other.time - one.time);
}

/// The last reading of the first set-up and the first of the second.
std::pair<Reading, Reading> AtTheChange(const std::vector<Reading>& plan) {
  const auto next = std::ranges::find(plan, 1, &Reading::setup);
  return {*std::prev(next), *next};
}

TEST(Schedules, OfPosesAreAsFarApartAsTheScenarioSays) {
  Scenario scenario = ShortFreeform();
  FreeformOf(scenario).freeform_procedure.interval_s = 0.5;
  FreeformOf(scenario).freeform_procedure.remount_s = 30.0;
  const std::vector<Reading> plan = procedure::FreeformSchedule(scenario);
  EXPECT_NEAR(Between_s(plan[0], plan[1]), 0.5, 1e-9);
  const auto [before, behind] = AtTheChange(plan);
  EXPECT_NEAR(Between_s(before, behind), 30.5, 1e-9);
}

TEST(Schedules, OfCirclesLetHandsWorkAsLongAsTheScenarioSays) {
  Scenario scenario = ShortCircles();
  const auto [before, behind] = AtTheChange(procedure::CircleSchedule(CircularOf(scenario).procedure));
  CircularOf(scenario).procedure.remount_s += 100.0;
  const auto [early, late] = AtTheChange(procedure::CircleSchedule(CircularOf(scenario).procedure));
  EXPECT_EQ(early.time, before.time);
  EXPECT_NEAR(Between_s(behind, late), 100.0, 1e-9);
}

}  // namespace
}  // namespace twinbench::test
