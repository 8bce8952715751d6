#include "twin/sim/environment.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <fstream>

#include "twin/core/errors.h"

namespace twinbench::sim {
namespace {

Time At(double t_s) {
  return Time{} + FromSeconds(t_s);
}

std::string WriteTemperatureFile(const std::string& text) {
  const std::string path = ::testing::TempDir() + "temperature.csv";
  std::ofstream(path) << text;
  return path;
}

TEST(Environment, AddsDriftAndSwingToItsLevel) {
  EnvironmentSettings settings;
  settings.drift_K_h = 0.5;
  settings.swing_K = 0.2;
  settings.swing_period_s = 1200.0;
  Environment room(settings, 1);
  EXPECT_NEAR(room.Temperature_degC(At(0.0)), 20.0, 1e-12);
  EXPECT_NEAR(room.Temperature_degC(At(300.0)), 20.0 + 0.5 / 12.0 + 0.2, 1e-12);
  EXPECT_NEAR(room.AboveReference_K(At(1200.0)), 0.5 / 3.0, 1e-12);
}

TEST(Environment, InterpolatesARecordAndHoldsItsEnds) {
  EnvironmentSettings settings;
  settings.temperature_file = WriteTemperatureFile("time_s,temperature_degC\n10,20\n20,21\n");
  Environment room(settings, 1);
  EXPECT_DOUBLE_EQ(room.Temperature_degC(At(0.0)), 20.0);
  EXPECT_DOUBLE_EQ(room.Temperature_degC(At(15.0)), 20.5);
  EXPECT_DOUBLE_EQ(room.Temperature_degC(At(99.0)), 21.0);
}

TEST(Environment, NamesTheLineOfABadRecord) {
  EnvironmentSettings settings;
  settings.temperature_file = WriteTemperatureFile("time_s,temperature_degC\n10,20\nten,21\n");
  try {
    Environment room(settings, 1);
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("temperature.csv:3"), std::string::npos) << error.what();
  }
}

TEST(Environment, WalksTheSameWayWhicheverTimesAreAskedFor) {
  EnvironmentSettings settings;
  settings.random_walk_K_sqrt_h = 0.1;
  Environment often(settings, 7), once(settings, 7);
  for (int k = 0; k < 100; ++k) often.Temperature_degC(At(36.0 * k));
  EXPECT_EQ(often.Temperature_degC(At(3600.0)), once.Temperature_degC(At(3600.0)));
}

TEST(Environment, WalksAsFarAsItsFigureSays) {
  EnvironmentSettings settings;
  settings.random_walk_K_sqrt_h = 0.1;
  double sum = 0.0;
  constexpr int kRooms = 400;
  for (int seed = 0; seed < kRooms; ++seed) {
    Environment room(settings, static_cast<std::uint64_t>(seed));
    sum += std::pow(room.AboveReference_K(At(4.0 * 3600.0)), 2);
  }
  // 0.1 K after one hour is 0.2 K after four; relative deviation of the variance sqrt(2 / 400) = 0.07, 4 of them.
  EXPECT_NEAR(sum / kRooms / 0.04, 1.0, 0.28);
}

}  // namespace
}  // namespace twinbench::sim
