#include <gtest/gtest.h>

#include <cmath>

#include "tests/sim/quiet_scenario.h"
#include "twin/benches/rotary_4dof/twin/twin.h"

namespace twinbench::sim {
namespace {

TEST(Ruling, ShowsWhereABeamMeetsTheGratingBesideItsMiddle) {
  Scenario scenario = Quiet();
  RotaryOf(scenario).laser.position_m.x() = 2e-3;
  const double before_V = Twin(scenario).Bench().adc.Acquire(4, false).channel[0].mean_V;
  RotaryOf(scenario).grating.ruling_chirp_per_m = 50e-6 / units::mm;
  const double after_V = Twin(scenario).Bench().adc.Acquire(4, false).channel[0].mean_V;
  const double cosine = std::sqrt(1.0 - 0.39 * 0.39), turned_rad = 2.0 * 50e-6 * 0.39 / cosine;
  // The spot lies 2 mm cos aside on its detector: the way to it is as long, seen from there.
  EXPECT_NEAR(after_V - before_V, -2000.0 * 0.12 * turned_rad, 0.02 * 2000.0 * 0.12 * turned_rad);
}

}  // namespace
}  // namespace twinbench::sim
