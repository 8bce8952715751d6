#include <gtest/gtest.h>

#include "tests/circular_motion/circle_run.h"
#include "twin/benches/circular_motion/columns.h"
#include "twin/benches/circular_motion/twin/beside.h"
#include "twin/core/scenario.h"

// A machine that is driven by hand is still the machine of the procedure: what remembers goes on.
namespace twinbench::sim {
namespace {

using namespace benches::circular;

/// A room that swings, a drift that follows it late, noise, and one set-up of each instrument.
constexpr const char* kRemembering = R"(
bench = "circular_motion"
[environment]
swing_mK = 3000.0
swing_period_s = 60.0
sensor_noise_mK = 50.0
[[effect]]
name = "drift"
where = "y"
drift_um_K = 5.0
lag_s = 30.0
[[effect]]
name = "slip"
where = "x"
step_um = 3.0
at_reading = 60
[circular_procedure]
setups = [ { instrument = "bar", radius_mm = 100.0 }, { instrument = "grid", radius_mm = 110.230 } ]
feeds_mm_min = [1000.0]
points = 24
)";

TEST(CirclesBesideThePlan, ShowWhatThePlanShowsWhereTheyAreTheSame) {
  const CircleRun run(ParseScenario(kRemembering, "remembering", ".", {}));
  const int half = run.Readings() / 2;
  std::vector<Reading> taken;
  for (int i = 0; i < half; ++i) taken.push_back(run.Take(i));
  CircleBeside beside(run, taken);
  for (int i = half; i < run.Readings(); ++i) {
    const Reading planned = run.Take(i), shown = beside.Take(run.Planned(i));
    EXPECT_EQ(shown.temperature_degC, planned.temperature_degC) << i;
    EXPECT_NEAR(DeviationOf(shown).radial_m, DeviationOf(planned).radial_m, 1e-12) << i;
    EXPECT_NEAR(DeviationOf(shown).tangential_m, DeviationOf(planned).tangential_m, 1e-12) << i;
  }
}

}  // namespace
}  // namespace twinbench::sim
