#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/import/importing.h"
#include "tests/support/kept_text.h"

/// A command that jumps, and a servo that takes its time.
namespace twinbench::imports {
namespace {

using testing::HasSubstr, testing::Not;

struct Servo {
  double speed_deg_s = 205.0, low_deg = 0.04, noise_deg = 0.01;
  double rest_s = 1.0, last_rest_s = 1.0;
};

/// A square wave of 140 deg, 20 rests, a row every 13 ms.
std::string StepTest(const Servo& servo) {
  std::mt19937_64 random(4);
  std::normal_distribution<double> noise(0.0, servo.noise_deg);
  std::string text = "time [s];commanded [deg];measured [deg]\n";
  double time_s = 0.0, at_deg = -60.0;
  for (int k = 0; k < 20; ++k) {
    const double to_deg = k % 2 == 0 ? -60.0 : 80.0, rest_s = k == 19 ? servo.last_rest_s : servo.rest_s;
    for (int i = 0; i < std::lround(rest_s / 0.013); ++i) {
      const double step_deg = 0.013 * servo.speed_deg_s;
      at_deg += std::clamp(to_deg - at_deg, -step_deg, step_deg);
      text += fmt::format("{:.3f};{:.1f};{:.3f}\n", time_s, to_deg, at_deg - servo.low_deg + noise(random));
      time_s += 0.013;
    }
  }
  return text;
}

TEST_F(Importing, TakesTheEndsOfRestsWhereTheDeviceStands) {
  const Imported imported = Take(StepTest({}));
  ASSERT_EQ(imported.readings.size(), 20u);
  for (const Reading& r : imported.readings) {
    // Means of 20 rows of 0.01 deg and more: 0.0022 deg, four times.
    EXPECT_NEAR((r.measured_rad - r.reference_rad) / units::deg, -0.04, 0.01);
    EXPECT_GE(r.n_samples, 15) << "it stands for the last 0.3 s of each rest";
  }
  EXPECT_GT(imported.readings[5].dwell_s, 0.65) << "it is on its way for 0.68 s";
  EXPECT_THAT(imported.story, HasSubstr("before the device stood"));
  EXPECT_THAT(imported.story, Not(HasSubstr("still on its way")));
}

TEST_F(Importing, KeepsTwoThirdsOfTheRestsOfAFastServo) {
  const Imported imported = Take(StepTest({.speed_deg_s = 2000.0}));
  ASSERT_EQ(imported.readings.size(), 20u);
  EXPECT_GE(imported.readings[5].n_samples, 45) << "of 77 rows";
}

/// It has arrived all the same: nothing goes on.
TEST_F(Importing, TakesAServoThatHuntsAboutItsPlaceForOneThatArrived) {
  std::string text = "time [s];commanded [deg];measured [deg]\n";
  for (int i = 0; i < 1600; ++i) {
    const double to_deg = i / 80 % 2 == 0 ? 20.0 : 120.0;
    text += fmt::format("{:.2f};{};{}\n", 0.05 * i, to_deg, to_deg == 120.0 && i * i % 7 < 4 ? to_deg - 13.0 : to_deg);
  }
  const Imported imported = Take(text);
  EXPECT_EQ(imported.readings.size(), 20u);
  EXPECT_THAT(imported.story, Not(HasSubstr("still on its way")));
}

TEST_F(Importing, SaysWhichRestsADeviceNeverReached) {
  const Imported some = Take(StepTest({.last_rest_s = 0.5}));
  EXPECT_EQ(some.readings.size(), 19u);
  EXPECT_THAT(some.story, HasSubstr("rows of 1 rests of the command at whose end the device was still on its way"));
}

/// A servo of 130 deg/s goes to and fro, and is where it was told at the beginning only.
TEST_F(Importing, RefusesStepsOfWhichNoneIsReached) {
  EXPECT_KEPT(MessageOf([&] { Take(StepTest({.speed_deg_s = 130.0})); }));
}

}  // namespace
}  // namespace twinbench::imports
