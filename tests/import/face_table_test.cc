#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "tests/import/importing.h"

// Tables of a certified polygon under an autocollimator: other names, orders, units and ways of saying the direction.
namespace twinbench::imports {
namespace {

using testing::Contains, testing::HasSubstr, testing::Not;

double Certified_arcsec(int face) {
  return 1.5 * std::sin(2.3 * face);
}
double Table_arcsec(double angle_deg, int direction) {
  return 3.0 * std::sin(angle_deg * units::deg) + (direction < 0 ? 0.2 : 0.0);
}

using FaceRow = std::function<std::string(int face, double angle_deg, double forward_arcsec, double reverse_arcsec)>;

std::string Faces(int faces, const FaceRow& row) {
  std::string text;
  for (int k = 0; k < faces; ++k) {
    const double angle_deg = 360.0 * k / faces, certified_arcsec = Certified_arcsec(k);
    text += row(k + 1, angle_deg, Table_arcsec(angle_deg, 1) + certified_arcsec, Table_arcsec(angle_deg, -1) + certified_arcsec);
  }
  return text;
}

class FaceTable : public Importing {
 protected:
  /// Each reading is the table's error at its face, and each way round a pass.
  static void Expect(const Imported& taken, int faces) {
    EXPECT_EQ(taken.bench, "turntable_autocollimator");
    EXPECT_THAT(taken.set, Contains(fmt::format("turntable_procedure.positions={}", faces)));
    ASSERT_EQ(taken.readings.size(), 2U * static_cast<std::size_t>(faces)) << taken.story;
    for (const Reading& r : taken.readings) {
      EXPECT_NEAR(r.autocollimator_yaw_rad / units::arcsec, Table_arcsec(r.target_rad / units::deg, r.direction), 2e-3);
      EXPECT_TRUE(std::isnan(r.autocollimator_tilt_rad));
    }
    EXPECT_EQ(taken.readings.front().direction, 1);
    EXPECT_EQ(taken.readings.back().direction, -1);
    EXPECT_LT(taken.readings.back().target_rad, 1e-9) << "the way back ends where the way there began";
    EXPECT_NE(taken.readings.front().pass, taken.readings.back().pass);
  }
};

TEST_F(FaceTable, IsGuessedByItsCertifiedDeviations) {
  const Imported taken = Take("face,nominal_deg,certified_dev_arcsec,reading_forward_arcsec,reading_reverse_arcsec\n" +
                              Faces(12, [](int face, double angle, double forward, double reverse) {
                                return fmt::format("{},{:g},{:.4f},{:.4f},{:.4f}\n", face, angle, Certified_arcsec(face - 1), forward, reverse);
                              }));
  Expect(taken, 12);
  EXPECT_THAT(taken.story, HasSubstr("taken as --map face_table"));
  EXPECT_THAT(taken.story, Not(HasSubstr("no certified deviations")));
}

TEST_F(FaceTable, MayBeGermanInRadAndSayTheDirectionInAColumn) {
  std::string there, back;
  Faces(24, [&](int face, double angle, double forward, double reverse) {
    const auto row = [&](const char* way, double shown) {
      std::string text = fmt::format("{};{:.6f};{:.9f};{:.9f}\n", way, angle, shown * units::arcsec * 1e6, Certified_arcsec(face - 1) * units::arcsec * 1e6);
      std::ranges::replace(text, '.', ',');
      return text;
    };
    there += row("vorwärts", forward);
    back = row("rückwärts", reverse) + back;
    return "";
  });
  Expect(Take("Richtung;Winkel [°];Ablesung [µrad];Kalibrierschein [µrad]\n" + there + back), 24);
}

TEST_F(FaceTable, WithoutCertifiedDeviationsSaysSo) {
  const Imported taken = Take("nominal [deg],autocollimator [arcsec]\n" + Faces(36, [](int, double angle, double forward, double) {
                                return fmt::format("{:g},{:.4f}\n", angle, forward);
                              }), "face_table");
  EXPECT_EQ(taken.readings.size(), 36U);
  EXPECT_THAT(taken.story, HasSubstr("no certified deviations were found"));
}

}  // namespace
}  // namespace twinbench::imports
