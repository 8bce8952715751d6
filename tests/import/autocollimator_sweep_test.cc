#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/import/importing.h"

// An autocollimator against a known angle: other names, orders, units and separators than the sample's.
namespace twinbench::imports {
namespace {

using testing::HasSubstr;

class AutocollimatorSweep : public Importing {
 protected:
  static void Expect(const Imported& taken, std::size_t readings, double slope) {
    ASSERT_EQ(taken.bench, "turntable_autocollimator") << taken.story;
    ASSERT_EQ(taken.readings.size(), readings) << taken.story;
    for (const Reading& r : taken.readings) {
      EXPECT_EQ(r.phase, Phase::kCalibration);
      EXPECT_NEAR(r.autocollimator_yaw_rad / units::arcsec, slope * r.target_rad / units::arcsec + 1.0, 2e-3);
    }
  }
};

TEST_F(AutocollimatorSweep, IsGuessedByItsNames) {
  std::string text = "Sollwinkel [µrad];Autokollimator [µrad]\n";
  for (int k = 0; k < 41; ++k) text += fmt::format("{};{:.4f}\n", 10 * k - 200, (1.01 * (10 * k - 200)) + 4.848137);
  const Imported taken = Take(text);
  Expect(taken, 41, 1.01);
  EXPECT_THAT(taken.story, HasSubstr("taken as --map autocollimator_sweep"));
  EXPECT_EQ(taken.readings.front().direction, 1);
}

TEST_F(AutocollimatorSweep, GoesThereAndBackInMinutesOfArc) {
  std::string text = "# sine bar, one sweep up and one down\nrun\tx (arcsec)\ty (arcsec)\ttilt (arcmin)\n";
  for (int k = 0; k < 42; ++k) {
    const double angle_arcmin = 0.5 * (k < 21 ? k : 41 - k);
    text += fmt::format("{}\t{:.4f}\t{:.4f}\t{}\n", k < 21 ? 1 : 2, 1.0 - 60.0 * angle_arcmin, 0.2, angle_arcmin);
  }
  const Imported taken = Take(text);
  Expect(taken, 42, -1.0);
  EXPECT_EQ(taken.readings.back().direction, -1);
  EXPECT_EQ(taken.readings.back().position, taken.readings.front().position);
  EXPECT_NE(taken.readings.back().pass, taken.readings.front().pass);
  EXPECT_NEAR(taken.readings.back().autocollimator_tilt_rad / units::arcsec, 0.2, 1e-6);
  EXPECT_THAT(taken.set, testing::Contains(HasSubstr("autocollimator.range_arcsec=8"))) << "beyond the usual one";
}

/// The turns of an axis beside what its encoder shows are no sweep of an autocollimator.
TEST_F(AutocollimatorSweep, IsNoComparisonOfTurns) {
  std::string text = "reference [deg],x [deg]\n";
  for (int k = 0; k < 73; ++k) text += fmt::format("{},{:.5f}\n", 5 * k, 5 * k + 0.01 * std::sin(0.3 * k));
  EXPECT_EQ(Take(text, "", {}).bench, "encoder_comparison");
}

}  // namespace
}  // namespace twinbench::imports
