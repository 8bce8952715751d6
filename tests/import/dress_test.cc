#include "tests/import/importing.h"
#include "tests/import/raw_files.h"
#include "tests/support/kept_text.h"

/// The same list in the dress of many programs and countries.
namespace twinbench::imports {
namespace {

using testing::HasSubstr;

constexpr int kRows = 72;

double Angle_deg(int i) { return 5.0 * i; }
double Shown_deg(int i) { return Angle_deg(i) + 0.05 * test::Cosine(1.0, Angle_deg(i), 40.0); }

/// @param row  Prints angle and shown, in deg.
template <class Row>
std::string Dressed(const std::string& head, Row row) {
  std::string text = head;
  for (int i = 0; i < kRows; ++i) text += row(Angle_deg(i), Shown_deg(i));
  return text;
}

/// @param form  Of 0 the angle, 1 what is shown, in deg.
std::string Dressed(const std::string& head, const char* form) {
  return Dressed(head, [form](double a, double b) { return fmt::format(fmt::runtime(form), a, b); });
}

std::string Grouped(double x, char thousands, char decimal) {
  std::string digits = fmt::format("{:.1f}", x);
  digits[digits.size() - 2] = decimal;
  for (std::ptrdiff_t at = std::ssize(digits) - 5; at > 0; at -= 3) digits.insert(static_cast<std::size_t>(at), 1, thousands);
  return digits;
}

std::string Dms(double x, const char* form) {
  const auto tenths = std::lround(std::abs(x) * 36000.0);
  return fmt::format(fmt::runtime(form), tenths / 36000, tenths / 600 % 60, 0.1 * static_cast<double>(tenths % 600));
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
  ExpectIt(Dressed("target,actual\n", "{} deg,{:.4f} deg\n"), "deg");
  ExpectIt(Dressed("target;actual\n", [](double a, double b) { return Dms(a, "{}° {:02d}' {:04.1f}\"") + ";" + Dms(b, "{}° {:02d}' {:04.1f}\"") + "\n"; }), "degrees, minutes, seconds");
  ExpectIt(Dressed("ref mrad;enc arcmin\n", [](double a, double b) { return fmt::format("{:.5f};{:.4f}\n", a * units::deg / units::mrad, 60 * b); }),
           "each its own");
}

/// "359:30:12.5", as theodolites have it; the clock beside it is one.
TEST_F(Dress, HasDegreesMinutesAndSecondsBetweenColons) {
  const auto colons = [](double x) { return Dms(x, "{}:{:02d}:{:04.1f}"); };
  for (const char* head : {"reference;measured\n", "target [deg];actual [deg]\n", "angle 1 [d:mm:ss];angle 2 [d:mm:ss]\n"})
    ExpectIt(Dressed(head, [&](double a, double b) { return colons(a) + ";" + colons(b) + "\n"; }), head);
  const Imported timed = Take(Dressed("time;reference;measured\n", [&](double a, double b) {
    return fmt::format("10:{:02d}:00;", std::lround(a / 10.0)) + colons(a / 15.0) + ";" + colons(b / 15.0) + "\n";
  }));
  EXPECT_NEAR(timed.readings.back().reference_rad / units::deg, 355.0 / 15.0, 1e-4) << "no more than 24 deg: the names say what it is";
  EXPECT_THAT(timed.story, HasSubstr("time (time of day)"));
}

TEST_F(Dress, IsALineOfNamesAndValues) {
  ExpectIt(Dressed("", "target={} actual={:.4f}\n"), "=");
  ExpectIt(Dressed("boot ok\n", "ref:{},enc:{:.4f}\n"), "a serial plotter's");
}

TEST_F(Dress, HasHeadsAndMarksOfItsProgram) {
  const char* row = "{};{:.4f}\n";
  ExpectIt(Dressed("sep=;\nreference [deg];measured [deg]\n", row), "a spreadsheet's first line");
  ExpectIt(Dressed("'reference [deg]';'measured [deg]'\n", "'{}';'{:.4f}'\n"), "quotes");
  ExpectIt(Dressed("Winkel soll [\xB0];Winkel ist [\xB0]\n", row), "Latin 1");
  ExpectIt(Dressed("  Reference   Measured\n    (deg)      (deg)\n", "{:11.3f}{:11.4f}\n"),
           "units below the names");
  ExpectIt(Dressed("| ref [deg] | enc [deg] |\n|---|---|\n", "| {} | {:.4f} |\n"), "Markdown");
  std::string again = "reference [deg];measured [deg]\n";
  for (int i = 0; i < kRows; ++i) again += (i == 40 ? "reference [deg];measured [deg]\n" : "") + fmt::format(fmt::runtime(row), Angle_deg(i), Shown_deg(i));
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
  EXPECT_THAT(Take(Dressed("Soll [Grad];Ist [Grad]\n", "{};{:.4f}\n")).story,
              HasSubstr("read as degrees"));
}

/// Tables of firmwares, however they were written down.

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
  EXPECT_THAT(MessageOf([&] { Take("measured [deg]\n" + Entries("\n")); }), HasSubstr("which column is reference_deg is not clear; there is only \"measured\""));
}

TEST_F(Importing, SaysWhyAFileHasNoPairs) {
  std::string statements, channels, stamped = "time,joint/header/stamp,joint/effort,joint/position\n";
  for (int k = 0; k < 40; ++k) {
    statements += fmt::format("Actual servo position: {}\n", 5 * k);
    stamped += fmt::format("{0},{0},0,{1}\n", 0.01 * k, 3.0 * k);
  }
  for (int channel = 0; channel < 4; ++channel) {
    for (int k = 0; k < 400; ++k) channels += fmt::format("{}{}", k > 0 ? "," : "", k * channel);
    channels += "\n";
  }
  const auto why = [&](const std::string& text) { return MessageOf([&] { Take(text); }); };
  EXPECT_THAT(why(statements), HasSubstr("each line states one quantity, \"Actual servo position\""));
  EXPECT_THAT(why(channels), HasSubstr("4 rows of 400 numbers each: a row for each channel?"));
  EXPECT_THAT(why(stamped), HasSubstr("reference_deg is not clear")) << "a time stamp is no angle";
  EXPECT_THAT(why("// const float lookup[] = {" + Entries(", ") + "};\nconst int sine[] = {" + "0, 3, 5, 3, 0, -3, -5, -3, 0, 3, 5, 3};\n"), HasSubstr("numbers stands in comments"));
  EXPECT_EQ(UnitNamed("millisec")->to_SI, 1e-3);
}

TEST_F(Importing, GuessesAPositioningTestByItsColumnsUpAndDown) {
  std::string text = "# stage 4\nangle [deg],forward [deg],backward [deg]\n";
  for (int i = 0; i < 12; ++i) text += fmt::format("{},{},{}\n", 30 * i, 30 * i + 0.1, 30 * i - 0.1);
  const Imported imported = TakeReadings(24, text);
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
    const Imported imported = TakeReadings(108, text);
    for (std::size_t k = 0; k < 108; ++k) {
      const Reading& r = imported.readings[k];
      EXPECT_EQ(r.pass, static_cast<int>(k / 36));
      EXPECT_EQ(r.position, static_cast<int>(k % 36)) << "the same places in every pass";
      EXPECT_EQ(r.direction, 1);
      EXPECT_NEAR(Error_deg(r), 0.1 * static_cast<double>(k / 36 + 1), 1e-9);
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
  const Imported imported = TakeReadings(30, text);
  const Reading& r = imported.readings.at(7);  // the third on the first way back
  EXPECT_EQ(r.direction, -1);
  EXPECT_NEAR(r.reference_rad / units::deg, 30.0, 1e-9) << "a degree a millimetre";
  EXPECT_NEAR(r.measured_rad / units::deg, 29.99, 1e-9);
  EXPECT_THAT(imported.story, HasSubstr("5 targets, 3 runs up, 3 down"));
}

}  // namespace
}  // namespace twinbench::imports
