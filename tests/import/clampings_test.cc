#include "twin/import/clampings.h"

#include "tests/import/importing.h"
#include "twin/core/stream.h"

// Polygons without a certificate in several clampings: said by columns, by their names, by lines above blocks, or
// by nothing but the readings.
namespace twinbench::imports {
namespace {

using testing::HasSubstr, testing::Not;

constexpr int kFaces = 10;

double TableError_arcsec(int place) {
  return 2.0 * std::sin(0.7 + units::turn * place / kFaces) + 0.6 * std::cos(2.0 * units::turn * place / kFaces);
}
double FaceError_arcsec(int face) { return 1.3 * std::sin(2.9 * (((face % kFaces) + kFaces) % kFaces) + 0.4); }
/// @param face  That stands before the autocollimator with the table at a place.
double Shown_arcsec(int place, int face, int clamping) {
  return TableError_arcsec(place) + FaceError_arcsec(face) + 4.0 * std::sin(1.7 * clamping);
}

class ClampingTable : public Importing {
 protected:
  /// Each reading is the error of the table where the bench says it stood and of the face that it says was seen,
  /// and a constant of its clamping.
  static void ExpectApart(const Imported& taken, int clampings, double within_arcsec = 1e-3) {
    ASSERT_EQ(taken.bench, "turntable_autocollimator");
    const double step_rad = units::turn / kFaces;
    std::vector<double> constant(static_cast<std::size_t>(clampings), kNaN);
    for (const Reading& r : taken.readings) {
      ASSERT_LT(r.setup, clampings);
      const auto place = static_cast<int>(std::lround(r.target_rad / step_rad)),
                 face = static_cast<int>(std::lround(-r.reference_rad / step_rad));
      const double own =
          r.autocollimator_yaw_rad / units::arcsec - TableError_arcsec(place) - FaceError_arcsec(face);
      double& of_clamping = constant[static_cast<std::size_t>(r.setup)];
      if (std::isnan(of_clamping)) of_clamping = own;
      EXPECT_NEAR(own, of_clamping, within_arcsec) << "reading " << r.reading << "\n" << taken.story;
    }
    EXPECT_TRUE(std::isfinite(constant.back())) << taken.story;
  }
};

TEST(ClampingNames, SayNumbersAndAngles) {
  const auto expect = [](const char* text, double number, double turned_deg) {
    EXPECT_EQ(ClampingIn(text), (ClampingSaid{number, turned_deg})) << text;
  };
  expect("clamping 2", 2.0, kNaN);
  expect("Setup3 forward", 3.0, kNaN);
  expect("Aufspannung Nr. 4: Polygon um 67,5° verdreht", 4.0, 67.5);
  expect("reading at -30 deg", kNaN, -30.0);
  expect("x_120deg", kNaN, 120.0);
  expect("offset 45", kNaN, 45.0);
  for (const char* other : {"reading 2", "temperature 20.5 °C", "u (k=2)", "certified 2024", "x"})
    expect(other, kNaN, kNaN);
  EXPECT_EQ(ClampingOf({"offset 30", "deg", {}, {}}), (ClampingSaid{kNaN, 30.0})) << "its unit was taken off";
}

TEST_F(ClampingTable, NamesFacesInAColumn) {
  std::string text = "face;table angle [deg];clamping;reading [arcsec]\n";
  for (int c = 0; c < 3; ++c)
    for (int k = 0; k < kFaces; ++k)
      text += fmt::format("{};{};{};{:.5f}\n", (k + 3 * c) % kFaces + 1, 36 * k, "ABC"[c],
                          Shown_arcsec(k, k + 3 * c, c));
  const Imported taken = Take(text);
  ExpectApart(taken, 3);
  EXPECT_THAT(taken.story, HasSubstr("taken as --map face_table"));
}

/// Both senses are tried: of the file's nothing is said.
TEST_F(ClampingTable, SaysOffsetsInNamesOfColumnsEitherWayRound) {
  for (const int sense : {1, -1}) {
    std::string text = "Winkel [gon],0° [µrad],36° [µrad],108° [µrad]\n";
    for (int k = 0; k < kFaces; ++k) {
      text += fmt::format("{}", 40 * k);
      for (const int turned : {0, 1, 3})
        text += fmt::format(",{:.6f}", Shown_arcsec(k, k + sense * turned, turned) * 4.84813681);
      text += "\n";
    }
    const Imported taken = Take(text, "face_table");
    ExpectApart(taken, 3);
    EXPECT_THAT(taken.story, Says("what the readings fit", "are the table's"));
  }
}

TEST_F(ClampingTable, StandsInBlocksBelowLines) {
  std::string text = "Indexing table, 20.1 °C\n";
  for (const int turned : {0, 2, 5}) {
    text += fmt::format("Mounting at {} deg\nface\tnominal [deg]\tx forward [arcsec]\tx reverse [arcsec]\n",
                        36 * turned);
    for (int k = 0; k < kFaces; ++k)
      text += fmt::format("{}\t{}\t{:.5f}\t{:.5f}\n", k + 1, 36 * k, Shown_arcsec(k + turned, k, turned),
                          Shown_arcsec(k + turned, k, turned));
  }
  const Imported taken = Take(text, "face_table");
  ExpectApart(taken, 3);
  EXPECT_EQ(taken.readings.size(), 6U * kFaces);
  EXPECT_THAT(taken.story, HasSubstr("the nominal angles are the faces'")) << "a face is the same in all of them";
}

/// By how much it was turned the readings show, if there are enough, by equal steps or not.
TEST_F(ClampingTable, MayOnlyNumberItsClampings) {
  for (const std::array<int, 4>& turned : {std::array{0, 3, 6, 9}, std::array{0, 1, 3, 7}, std::array{0, 9, 4, 6}}) {
    std::string text =
        "position (deg),clamping 1 (arcsec),clamping 2 (arcsec),clamping 3 (arcsec),clamping 4 (arcsec)\n";
    for (int k = 0; k < kFaces; ++k) {
      text += fmt::format("{}", 36 * k);
      for (int c = 0; c < 4; ++c) text += fmt::format(",{:.5f}", Shown_arcsec(k, k - turned[static_cast<std::size_t>(c)], c));
      text += "\n";
    }
    ExpectApart(Take(text), 4);
  }
}

/// Of clampings that are only numbered nobody knows the faces' errors either: what differs between both ways is found beside them.
TEST_F(ClampingTable, ReadBothWaysShowsItsHysteresis) {
  for (const double hysteresis_arcsec : {0.2, 1.0}) {
    Stream noise(4, "autocollimator.noise");
    std::string text = "angle_deg,x_arcsec,clamping,direction\n";
    constexpr std::array kTurned = {0, 1, 3, 7, 8};
    for (int c = 0; c < std::ssize(kTurned); ++c)
      for (const int way : {1, -1})
        for (int k = 0; k < kFaces; ++k) {
          const int place = way > 0 ? k : kFaces - 1 - k;
          text += fmt::format("{},{:.4f},{},{}\n", 36 * place, Shown_arcsec(place, place + kTurned[static_cast<std::size_t>(c)], 0) + 0.5 * hysteresis_arcsec * way + 0.03 * noise.Normal(), c + 1, way);
        }
    const Imported taken = Take(text);
    const diagnose::Diagnosis found = Diagnosed(taken);
    EXPECT_EQ(found.verdict, diagnose::Verdict::kNamed) << hysteresis_arcsec;
    ASSERT_EQ(found.causes.size(), 1U) << hysteresis_arcsec;
    EXPECT_EQ(found.causes[0].effect, "backlash");
    const diagnose::ParameterEstimate& width = found.causes[0].parameters.front();
    EXPECT_NEAR(width.value, -hysteresis_arcsec * units::arcsec, 3.0 * width.u);
    EXPECT_LT(width.u, 0.02 * units::arcsec);
  }
}

TEST_F(ClampingTable, IsNotTurnedWhereReadingsDoNotShowIt) {
  std::string text = "nominal_deg,clamping,reading_arcsec\n";
  for (int c = 0; c < 3; ++c)
    for (int k = 0; k < kFaces; ++k) text += fmt::format("{},{},{:.5f}\n", 36 * k, c + 1, Shown_arcsec(k, k, c));
  const Imported taken = Take(text);
  ExpectApart(taken, 3);
  EXPECT_THAT(taken.story, HasSubstr("taken as not turned"));
  ExpectApart(Take(text, "face_table", {"offset_deg=0 * clamping"}), 3);
}

/// Of two clampings a table and faces fit either sense.
TEST_F(ClampingTable, SaysWhereTheSenseIsAssumed) {
  std::string text = "nominal_deg,offset 0 deg [arcsec],offset 36 deg [arcsec]\n";
  for (int k = 0; k < kFaces; ++k)
    text += fmt::format("{},{:.5f},{:.5f}\n", 36 * k, Shown_arcsec(k, k, 0), Shown_arcsec(k, k + 1, 1));
  const Imported taken = Take(text);
  ExpectApart(taken, 2);
  EXPECT_THAT(taken.story, HasSubstr("the sense is assumed"));
  EXPECT_THAT(taken.story, Not(HasSubstr("what the readings fit")));
}

TEST_F(ClampingTable, RefusesOffsetsBetweenTheFaces) {
  std::string text = "nominal_deg,offset 0 deg [arcsec],offset 20 deg [arcsec],offset 72 deg [arcsec]\n";
  for (int k = 0; k < kFaces; ++k) text += fmt::format("{},{:.3f},{:.3f},{:.3f}\n", 36 * k, 0.1 * k, 0.2 * k, 0.1);
  EXPECT_THAT(MessageOf([&] { Take(text, "face_table"); }), HasSubstr("turned by 20 deg"));
}

/// Five positions are too few for a model of orders: it has none, and does not go from 1 to 0.
TEST_F(ClampingTable, OfFewPositionsHasNoOrders) {
  Stream noise(6, "autocollimator.noise");
  std::string text = "table angle [deg],reading [arcsec],offset [deg]\n";
  for (int c = 0; c < 3; ++c)
    for (int k = 0; k < 5; ++k) text += fmt::format("{},{:.4f},{}\n", 72 * k, (k == 2 ? 3.0 : 0.0) + (k + c == 4 ? 1.0 : 0.0) + 0.02 * noise.Normal(), 72 * c);
  const Imported taken = Take(text);
  const report::Evaluation evaluated = Evaluated(taken);
  EXPECT_THAT(evaluated.summary, HasSubstr("harmonic model          no order")) << evaluated.summary;
}

/// The circle's last reading is its first place again, one face was not read, and clampings stand beside each
/// other.
TEST_F(ClampingTable, MayCloseTheCircleAndLackAFace) {
  std::string text = "nominal [deg],clamping,offset [deg],autocollimator [arcsec]\n";
  for (int k = 0; k <= kFaces; ++k) {
    for (const int turned : {0, 1, 4}) {
      if (k == 7 && turned == 1) continue;
      text += fmt::format("{},K{},{},{:.5f}\n", 36 * k, turned, 36 * turned, Shown_arcsec(k, k + turned, turned));
    }
  }
  const Imported taken = Take(text);
  ExpectApart(taken, 3);
  EXPECT_EQ(taken.readings.front().setup, taken.readings[10].setup) << "sorted by clamping";
  EXPECT_THAT(taken.set, testing::Contains("multitooth.teeth=10"));
}

}  // namespace
}  // namespace twinbench::imports
