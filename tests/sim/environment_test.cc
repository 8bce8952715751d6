#include "twin/sim/environment.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/core/input_error.h"

namespace twinbench::sim {
namespace {

Time At(double t_s) {
  return Time{} + FromSeconds(t_s);
}

TEST(Environment, AddsDriftAndSwingToItsLevelOrInterpolatesARecord) {
  EnvironmentSettings settings;
  settings.drift_K_h = 0.5;
  settings.swing_K = 0.2;
  settings.swing_period_s = 1200.0;
  Environment room(settings, 1);
  EXPECT_NEAR(room.Temperature_degC(At(0.0)), 20.0, 1e-12);
  EXPECT_NEAR(room.Temperature_degC(At(300.0)), 20.0 + 0.5 / 12.0 + 0.2, 1e-12);
  EXPECT_NEAR(room.AboveReference_K(At(1200.0)), 0.5 / 3.0, 1e-12);
  const TemporaryFolder folder;
  EnvironmentSettings recorded;
  recorded.temperature_file = folder.Write("room.csv", "time_s,temperature_degC\n10,20\n20,21\n");
  EXPECT_DOUBLE_EQ(Environment(recorded, 1).Temperature_degC(At(15.0)), 20.5);
}

TEST(Environment, WalksAsFarAsItsFigureSaysAndTheSameWayWhicheverTimesAreAskedFor) {
  EnvironmentSettings settings;
  settings.random_walk_K_sqrt_h = 0.1;
  Environment often(settings, 7), once(settings, 7);
  for (int k = 0; k < 100; ++k) often.Temperature_degC(At(36.0 * k));
  EXPECT_EQ(often.Temperature_degC(At(3600.0)), once.Temperature_degC(At(3600.0)));
  double sum = 0.0;
  constexpr int kRooms = 400;
  for (std::uint64_t seed = 0; seed < kRooms; ++seed)
    sum += std::pow(Environment(settings, seed).AboveReference_K(At(4.0 * 3600.0)), 2);
  // 0.1 K after one hour is 0.2 K after four; relative deviation of the variance sqrt(2 / 400) = 0.07, 4 of them.
  EXPECT_NEAR(sum / kRooms / 0.04, 1.0, 0.28);
}

}  // namespace
}  // namespace twinbench::sim
