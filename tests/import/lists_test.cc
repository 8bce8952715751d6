#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>

#include "tests/import/importing.h"
#include "tests/import/raw_files.h"
#include "tests/support/kept_text.h"

/// Tables of firmwares, however they were written down.
namespace twinbench::imports {
namespace {

using testing::HasSubstr;

/// 2.4 deg once per turn and 0.3 deg twice, in rad, from the angle that the encoder's count would be.
std::string Entries(const char* between, int count = 360) {
  std::string text;
  for (int i = 0; i < count; ++i) {
    const double angle_deg = 360.0 * i / count;
    const double error_deg = 2.4 * test::Cosine(1.0, angle_deg, 30.0) + 0.3 * test::Cosine(2.0, angle_deg, 80.0);
    text += fmt::format("{}{:.6f}", i > 0 ? between : "", test::OnceRound(angle_deg - error_deg) * units::deg);
  }
  return text;
}

/// Twice the mean of the error times the wave, taken with a cosine and a sine.
double Order_deg(const Imported& imported, int order) {
  double c = 0.0, s = 0.0;
  for (const Reading& r : imported.readings) {
    const double e = std::remainder(r.measured_rad - r.reference_rad, units::turn) / units::deg;
    c += e * std::cos(order * r.measured_rad);
    s += e * std::sin(order * r.measured_rad);
  }
  return 2.0 * std::hypot(c, s) / static_cast<double>(imported.readings.size());
}

TEST_F(Importing, TakesAListOfNumbersInAnyDress) {
  const std::string numbers = Entries(", ");
  for (const std::string& text : {numbers, numbers + "\n", Entries(" "), Entries("\n"), Entries("\n") + "\n", "{" + numbers + "};", "[" + numbers + "]",
                                  "lookup = [" + numbers + "]\n", "lut = np.array([" + numbers + "])\n", "float lut[360] PROGMEM = {" + numbers + "};",
                                  "std::array<float, 360> lut = {" + numbers + "};", "// of tuesday\nfloat lut[] =\n{" + Entries("f,\n") + "f\n};\n"}) {
    const Imported imported = Take(text, "lookup_table");
    ASSERT_EQ(imported.readings.size(), 360u) << text.substr(0, 60);
    EXPECT_NEAR(Order_deg(imported, 1), 2.4, 0.01) << text.substr(0, 60);
    EXPECT_NEAR(Order_deg(imported, 2), 0.3, 0.01) << text.substr(0, 60);
  }
}

std::string Errors16Bit(double order_1_deg, double order_2_deg) {
  std::string text = "uint16_t calibrationLut[200] = {";
  for (int i = 0; i < 200; ++i) {
    const double error_deg = order_1_deg * test::Cosine(1.0, 1.8 * i, 120.0) + order_2_deg * test::Cosine(2.0, 1.8 * i, 10.0);
    text += fmt::format("{}, ", 32768 + std::lround(65536.0 * error_deg / 360.0));
  }
  return text + "};\n";
}

TEST_F(Importing, TakesCorrectionsInRadOrIn16BitAboutTheirMiddle) {
  const Imported imported = Take(Errors16Bit(0.55, 0.42), "correction_table");
  EXPECT_NEAR(Order_deg(imported, 1), 0.55, 0.01) << "a count is 0.0055 deg";
  EXPECT_NEAR(Order_deg(imported, 2), 0.42, 0.01);
  EXPECT_THAT(imported.story, HasSubstr("32768 is none"));
  EXPECT_KEPT(MessageOf([&] { Take("int lut[4] = {100, 900, -300, 0};", "correction_table"); }));
}

/// What a file is can be seen from its entries: angles go round once, errors are small.
TEST_F(Importing, GuessesTheReadyMapOfAListAndSaysIt) {
  EXPECT_NEAR(Order_deg(Take(Entries(", ")), 1), 2.4, 0.01);
  EXPECT_THAT(Take(Entries(", ")).story, HasSubstr("lookup_table"));
  EXPECT_NEAR(Order_deg(Take("lut = [\n" + Entries(",\n") + "\n]\n"), 1), 2.4, 0.01);
  EXPECT_NEAR(Order_deg(Take(Errors16Bit(0.55, 0.42)), 1), 0.55, 0.01);
  EXPECT_THAT(Take(Errors16Bit(0.55, 0.42)).story, HasSubstr("correction_table"));
}

TEST_F(Importing, AsksForTheReferenceOfASingleColumn) {
  EXPECT_THAT(MessageOf([&] { Take("measured [deg]\n" + Entries("\n")); }), HasSubstr("which column is reference_deg is not clear; there are \"measured\""));
}

TEST_F(Importing, GuessesAPositioningTestByItsColumnsUpAndDown) {
  std::string text = "# stage 4\nangle [deg],forward [deg],backward [deg]\n";
  for (int i = 0; i < 12; ++i) text += fmt::format("{},{},{}\n", 30 * i, 30 * i + 0.1, 30 * i - 0.1);
  const Imported imported = Take(text);
  ASSERT_EQ(imported.readings.size(), 24u);
  EXPECT_EQ(imported.readings[12].direction, -1);
  EXPECT_THAT(imported.story, HasSubstr("a positioning test"));
  EXPECT_EQ(Take(text, "", {"reference_deg=angle", "measured_deg=forward"}).readings.size(), 12u) << "who names columns means them";
}

/// Several columns of one length beside a reference, and nobody says that any of them went back.
TEST_F(Importing, TakesNumberedRunsForPassesInTheOrderOfTheRows) {
  for (const char* names : {"reference [deg];run 1 [deg];run 2 [deg];run 3 [deg]", "no.;Sollwert [deg];Lauf 1;Lauf 2;Lauf 3", "angle [deg];1;2;3"}) {
    std::string text = std::string(names) + "\n";
    const bool counted = text.starts_with("no.");
    for (int i = 0; i < 36; ++i) text += fmt::format("{}{};{:.3f};{:.3f};{:.3f}\n", counted ? fmt::format("{};", i) : "", 10 * i, 10 * i + 0.1, 10 * i + 0.2, 10 * i + 0.3);
    const Imported imported = Take(text);
    ASSERT_EQ(imported.readings.size(), 108u) << imported.story;
    for (std::size_t k = 0; k < 108; ++k) {
      const Reading& r = imported.readings[k];
      EXPECT_EQ(r.pass, static_cast<int>(k / 36));
      EXPECT_EQ(r.position, static_cast<int>(k % 36)) << "the same places in every pass";
      EXPECT_EQ(r.direction, 1);
      EXPECT_NEAR((r.measured_rad - r.reference_rad) / units::deg, 0.1 * static_cast<double>(k / 36 + 1), 1e-9);
    }
    EXPECT_THAT(imported.story, HasSubstr("nothing says in which direction the 3 runs went")) << names;
  }
  EXPECT_THAT(Take("time [s];run 1;run 2\n0;0;0\n1;10;10\n2;20;20.1\n3;30;30\n").story, testing::Not(HasSubstr("runs went"))) << "along a time nobody goes";
}

/// A value a line, as controllers print a test: indices of the target and of the run.
TEST_F(Importing, ReadsAPositioningTestOfIndexedLines) {
  std::string text = "TEST_DATA=# of tuesday\nUNIT=mm\nCYCLES=3\n";
  for (int i = 1; i <= 5; ++i) text += fmt::format("TGT_DATA[{}]={}\n", i, 10 * i);
  for (int run = 1; run <= 3; ++run) {
    for (int i = 1; i <= 5; ++i) text += fmt::format("REF_DATA_FWD[{},{}]={:.3f}\n", i, run, 10 * i + 0.01 * run);
    for (int i = 5; i >= 1; --i) text += fmt::format("REF_DATA_BWD[{},{}]={:.3f}\n", i, run, 10 * i - 0.01 * run);
  }
  const Imported imported = Take(text);
  ASSERT_EQ(imported.readings.size(), 30u) << imported.story;
  const Reading& r = imported.readings.at(7);  // the third on the first way back
  EXPECT_EQ(r.direction, -1);
  EXPECT_NEAR(r.reference_rad / units::deg, 30.0, 1e-9) << "a degree a millimetre";
  EXPECT_NEAR(r.measured_rad / units::deg, 29.99, 1e-9);
  EXPECT_THAT(imported.story, HasSubstr("5 targets, 3 runs up, 3 down"));
}

}  // namespace
}  // namespace twinbench::imports
