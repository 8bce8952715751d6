#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "tests/support/twin_run.h"
#include "twin/benches/rotary_4dof/settings.h"

// What happens in a run as a newcomer types it: docs/architecture.md, events and functions of time.
namespace twinbench {
namespace {

struct WatchedRun {
  std::vector<Reading> readings;
  std::map<std::string, std::uint64_t> events;
  std::uint64_t rays = 0;
};

WatchedRun Watched(const Scenario& scenario) {
  sim::Twin twin(scenario);
  RotaryBench bench = twin.Bench();
  test::MemorySink sink;
  procedure::CarryOut(bench, scenario, sink);
  return {sink.readings, twin.ScheduledEvents(), twin.RaysTraced()};
}

TEST(DefaultRun, SchedulesWhatEveryDeviceDoesAndTracesAllItsLight) {
  const Scenario scenario = LoadScenario(test::ScenarioPath("rotary_4dof.toml"));
  ASSERT_EQ(RotaryOf(scenario).mechanics.fidelity, "bullet");
  ASSERT_EQ(RotaryOf(scenario).optics.fidelity, "traced");
  const WatchedRun run = Watched(scenario);
  std::set<std::pair<Phase, int>> mountings;
  std::uint64_t stops = 0, swept = 0;
  for (const Reading& r : run.readings) {
    mountings.insert({r.phase, r.setup});
    stops += r.phase == Phase::kFullCircle ? 1 : 0;
    swept += std::isfinite(r.autocollimator_yaw_rad) ? 1 : 0;
  }
  ASSERT_EQ(stops, 576U);
  EXPECT_EQ(run.events.at("fixture"), mountings.size());
  EXPECT_EQ(run.events.at("thermometer"), run.readings.size());
  EXPECT_EQ(run.events.at("autocollimator"), swept);
  EXPECT_GE(run.events.at("goniometer"), swept);
  // One end of a profile a move, and for the servos, counted with the target, a step each of the 600 ms and more
  // that a move takes.
  EXPECT_GE(run.events.at("reference"), stops);
  EXPECT_GE(run.events.at("target"), 600 * stops);
  // The floor of a quiet laboratory shakes: three steps in a block of 1.6 ms, the fewest that a cubic needs.
  EXPECT_EQ(run.events.at("adc"), 4 * run.readings.size());
  // The light is found at every knot: the chief ray to the grating, past all that stands in the room, and two
  // orders.
  EXPECT_GE(run.rays, 4 * run.events.at("adc"));
}

// Where nothing moves a block is its begin and its end, and tables that stand where they are sent have no servos.
TEST(DefaultRun, AsksNoMoreWhereNothingIsFast) {
  Scenario scenario = LoadScenario(test::ScenarioPath("rotary_4dof.toml"), {"mechanics.fidelity=kinematic"});
  const WatchedRun run = Watched(scenario);
  EXPECT_EQ(run.events.at("adc"), 2 * run.readings.size());
  EXPECT_LT(run.events.at("target"), 2 * run.readings.size());
}

}  // namespace
}  // namespace twinbench
