#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/import/importing.h"
#include "twin/benches/turntable_autocollimator/bench.h"
#include "twin/core/stream.h"

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

TEST_F(AutocollimatorSweep, MayBeThatOfYInAnySense) {
  std::string text = "SAG (arcsec),x (arcsec),y (arcsec)\n";
  for (int k = 0; k < 41; ++k) text += fmt::format("{},{:.3f},{:.4f}\n", 10 * k - 200, 0.02 * (k % 3), -1.01 * (10 * k - 200));
  const Imported taken = Take(text);
  ASSERT_EQ(taken.bench, "turntable_autocollimator") << taken.story;
  EXPECT_EQ(taken.readings.front().phase, Phase::kCalibration);
  EXPECT_NEAR(taken.readings.front().autocollimator_tilt_rad / units::arcsec, 202.0, 1e-6);
}

/// Whoever made it turned the instrument as he liked: no cause is the other sense.
TEST_F(AutocollimatorSweep, IsDiagnosedInTheSenseThatItHas) {
  for (const double sense : {1.0, -1.0}) {
    Stream noise(5, "autocollimator.noise");
    std::string text = "reference (arcsec),y (arcsec)\n";
    for (int k = 0; k < 81; ++k) {
      const double angle_arcsec = 5.0 * k - 200.0;
      text += fmt::format("{},{:.4f}\n", angle_arcsec, sense * (angle_arcsec + 0.3 * std::cos(units::turn * angle_arcsec / 40.0) + 0.02 * noise.Normal()));
    }
    const Imported taken = Take(text);
    const diagnose::Diagnosis found =
        benches::turntable::Diagnose(taken.readings, ParseScenario("bench = \"" + taken.bench + "\"\n", "sweep.csv", "", taken.set), {}).diagnosis;
    ASSERT_FALSE(found.causes.empty()) << sense;
    EXPECT_EQ(found.causes[0].effect, "autocollimator_periodic") << sense;
    EXPECT_EQ(std::ranges::count_if(found.notes, [](const std::string& note) { return note.find("counts against") != std::string::npos; }), sense < 0.0 ? 1 : 0);
  }
}

/// The turns of an axis beside what its encoder shows are no sweep of an autocollimator.
TEST_F(AutocollimatorSweep, IsNoComparisonOfTurns) {
  std::string text = "reference [deg],x [deg]\n";
  for (int k = 0; k < 73; ++k) text += fmt::format("{},{:.5f}\n", 5 * k, 5 * k + 0.01 * std::sin(0.3 * k));
  EXPECT_EQ(Take(text, "", {}).bench, "encoder_comparison");
}

}  // namespace
}  // namespace twinbench::imports
