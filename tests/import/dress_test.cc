#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>

#include "tests/import/importing.h"
#include "tests/import/raw_files.h"

/// The same list in the dress of many programs and countries.
namespace twinbench::imports {
namespace {

using testing::HasSubstr;

constexpr int kRows = 72;

double Angle_deg(int i) {
  return 5.0 * i;
}
double Shown_deg(int i) {
  return Angle_deg(i) + 0.05 * test::Cosine(1.0, Angle_deg(i), 40.0);
}

/// @param row  Prints angle and shown, in deg.
template <class Row>
std::string Dressed(const std::string& head, Row row) {
  std::string text = head;
  for (int i = 0; i < kRows; ++i) text += row(Angle_deg(i), Shown_deg(i));
  return text;
}

std::string Grouped(double x, char thousands, char decimal) {
  std::string digits = fmt::format("{:.1f}", x);
  digits[digits.size() - 2] = decimal;
  for (std::ptrdiff_t at = std::ssize(digits) - 5; at > 0; at -= 3) digits.insert(static_cast<std::size_t>(at), 1, thousands);
  return digits;
}

std::string Dms(double x) {
  const auto tenths = std::lround(std::abs(x) * 36000.0);
  return fmt::format("{}{}° {:02d}' {:04.1f}\"", x < 0.0 ? "-" : "", tenths / 36000, tenths / 600 % 60, 0.1 * static_cast<double>(tenths % 600));
}

class Dress : public Importing {
 protected:
  void ExpectIt(const std::string& text, const char* what, double within_deg = 1e-3) {
    const Imported imported = Take(text);
    ASSERT_EQ(std::ssize(imported.readings), kRows) << what << "\n" << imported.story;
    for (int i = 0; i < kRows; ++i) {
      const Reading& r = imported.readings[static_cast<std::size_t>(i)];
      EXPECT_NEAR(r.reference_rad / units::deg, Angle_deg(i), within_deg) << what;
      EXPECT_NEAR(r.measured_rad / units::deg, Shown_deg(i), within_deg) << what;
    }
  }
};

TEST_F(Dress, HasMarksOfThousands) {
  ExpectIt(Dressed("Sollwert [arcsec];Istwert [arcsec]\r\n",
                   [](double a, double b) { return Grouped(3600 * a, '.', ',') + ";" + Grouped(3600 * b, '.', ',') + "\r\n"; }),
           "1.234,5");
  ExpectIt(Dressed("Target (arcsec),Actual (arcsec)\n",
                   [](double a, double b) { return "\"" + Grouped(3600 * a, ',', '.') + "\",\"" + Grouped(3600 * b, ',', '.') + "\"\n"; }),
           "\"1,234.5\"");
}

TEST_F(Dress, HasUnitsInItsCells) {
  ExpectIt(Dressed("target,actual\n", [](double a, double b) { return fmt::format("{} deg,{:.4f} deg\n", a, b); }), "deg");
  ExpectIt(Dressed("target;actual\n", [](double a, double b) { return Dms(a) + ";" + Dms(b) + "\n"; }), "degrees, minutes, seconds");
  ExpectIt(Dressed("ref mrad;enc arcmin\n", [](double a, double b) { return fmt::format("{:.5f};{:.4f}\n", a * units::deg / units::mrad, 60 * b); }),
           "each its own");
}

/// "359:30:12.5", as theodolites have it; the clock beside it is one.
TEST_F(Dress, HasDegreesMinutesAndSecondsBetweenColons) {
  const auto colons = [](double x) {
    const auto tenths = std::lround(std::abs(x) * 36000.0);
    return fmt::format("{}{}:{:02d}:{:04.1f}", x < 0.0 ? "-" : "", tenths / 36000, tenths / 600 % 60, 0.1 * static_cast<double>(tenths % 600));
  };
  for (const char* head : {"reference;measured\n", "target [deg];actual [deg]\n", "angle 1 [d:mm:ss];angle 2 [d:mm:ss]\n"})
    ExpectIt(Dressed(head, [&](double a, double b) { return colons(a) + ";" + colons(b) + "\n"; }), head);
  const Imported timed = Take(Dressed("time;reference;measured\n", [&](double a, double b) {
    return fmt::format("10:{:02d}:00;", std::lround(a / 10.0)) + colons(a / 15.0) + ";" + colons(b / 15.0) + "\n";
  }));
  EXPECT_NEAR(timed.readings.back().reference_rad / units::deg, 355.0 / 15.0, 1e-4) << "no more than 24 deg: the names say what it is";
  EXPECT_THAT(timed.story, HasSubstr("time (time of day)"));
}

TEST_F(Dress, IsALineOfNamesAndValues) {
  ExpectIt(Dressed("", [](double a, double b) { return fmt::format("target={} actual={:.4f}\n", a, b); }), "=");
  ExpectIt(Dressed("boot ok\n", [](double a, double b) { return fmt::format("ref:{},enc:{:.4f}\n", a, b); }), "a serial plotter's");
}

TEST_F(Dress, HasHeadsAndMarksOfItsProgram) {
  const auto row = [](double a, double b) { return fmt::format("{};{:.4f}\n", a, b); };
  ExpectIt(Dressed("sep=;\nreference [deg];measured [deg]\n", row), "a spreadsheet's first line");
  ExpectIt(Dressed("'reference [deg]';'measured [deg]'\n", [](double a, double b) { return fmt::format("'{}';'{:.4f}'\n", a, b); }), "quotes");
  ExpectIt(Dressed("Winkel soll [\xB0];Winkel ist [\xB0]\n", row), "Latin 1");
  ExpectIt(Dressed("  Reference   Measured\n    (deg)      (deg)\n", [](double a, double b) { return fmt::format("{:11.3f}{:11.4f}\n", a, b); }),
           "units below the names");
  ExpectIt(Dressed("| ref [deg] | enc [deg] |\n|---|---|\n", [](double a, double b) { return fmt::format("| {} | {:.4f} |\n", a, b); }), "Markdown");
  std::string again = "reference [deg];measured [deg]\n";
  for (int i = 0; i < kRows; ++i) again += (i == 40 ? "reference [deg];measured [deg]\n" : "") + row(Angle_deg(i), Shown_deg(i));
  ExpectIt(again, "its head again");
}

TEST_F(Dress, HasTheMinusOfAWordProcessor) {
  std::string text = "reference [deg],measured [deg]\n";
  for (int i = 0; i < kRows; ++i) text += fmt::format("−{}.0,−{}.5\n", 5 * i + 5, 5 * i + 5);
  const Imported imported = Take(text);
  ASSERT_EQ(std::ssize(imported.readings), kRows);
  EXPECT_NEAR(imported.readings[3].measured_rad / units::deg, -20.5, 1e-9);
}

TEST_F(Dress, SaysThatGradAreReadAsDegrees) {
  EXPECT_THAT(Take(Dressed("Soll [Grad];Ist [Grad]\n", [](double a, double b) { return fmt::format("{};{:.4f}\n", a, b); })).story,
              HasSubstr("read as degrees"));
}

}  // namespace
}  // namespace twinbench::imports
