#include "tests/core/input_error.h"
#include "tests/report/page_lines.h"
#include "tests/support/kept_text.h"
#include "twin/report/compensation_text.h"
#include "twin/report/controller_tables.h"
#include "twin/report/curve_score.h"
#include "twin/report/curve_text.h"
#include "twin/report/text_table.h"

namespace twinbench::report {
namespace {

using testing::HasSubstr, testing::Not;

constexpr std::size_t kFrame = 11;    // letters before the first place: labels and the axis
constexpr std::size_t kPlaces = 68;   // across
constexpr std::size_t kFirstRow = 1;  // behind the title
constexpr std::size_t kRows = 15;

/// Two levels, with a step back in the middle of the forward one.
CurveText Steps() {
  CurveText curve;
  curve.title = "Error [um]";
  curve.x_name = "angle [deg]";
  for (int k = 0; k <= 4; ++k) {
    curve.x.push_back(90.0 * k);
    curve.forward.push_back(k == 2 ? -1.0 : 1.0);
    curve.backward.push_back(-1.0);
  }
  return curve;
}

/// The letter of the plot at a place and a row, both from 0; a blank where the line has ended.
char At(const std::vector<std::string>& lines, std::size_t row, std::size_t place) {
  const std::string& line = lines.at(kFirstRow + row);
  return kFrame + place < line.size() ? line[kFrame + place] : ' ';
}

TEST(PlotOf, PutsEveryPointWhereItBelongs) {
  const auto lines = test::LinesOf(PlotOf(Steps(), Letters::kAscii));
  EXPECT_EQ(lines.at(0), "Error [um]");
  const std::size_t last = kPlaces - 1, bottom = kRows - 1;
  EXPECT_EQ(At(lines, 0, 0), '>');
  EXPECT_EQ(At(lines, 0, last), '>');
  EXPECT_EQ(At(lines, bottom, 0), '<');
  EXPECT_EQ(At(lines, bottom, last), '<');
  // The middle place, 2 of 0 to 4, lies at dot 68 of 0 to 135: letter 34. Both meet there.
  EXPECT_EQ(At(lines, bottom, 34), 'x');
  EXPECT_EQ(At(lines, 0, 34), ' ');
  // Zero lies between: a row of dots.
  EXPECT_EQ(At(lines, kRows / 2, 5), '.');
}

TEST(PlotOf, LabelsBothAxesWithTheirEndsAndZeroWithoutASign) {
  const auto lines = test::LinesOf(PlotOf(Steps(), Letters::kAscii));
  EXPECT_THAT(lines.at(kFirstRow), HasSubstr("1.00|"));
  EXPECT_THAT(lines.at(kFirstRow + kRows - 1), HasSubstr("-1.00|"));
  const std::string& axis = lines.at(kFirstRow + kRows + 1);
  EXPECT_EQ(axis.substr(kFrame, 2), "0 ");
  EXPECT_EQ(axis.substr(axis.size() - 4), " 360");
  EXPECT_THAT(lines.at(kFirstRow + kRows + 2), HasSubstr("angle [deg]"));
  EXPECT_THAT(lines.back(), HasSubstr("> forward   < backward   x both"));
  CurveText near_zero = Steps();
  for (double& value : near_zero.forward) value *= 0.999;  // the middle is -0.0005
  EXPECT_THAT(test::LinesOf(PlotOf(near_zero, Letters::kAscii)).at(kFirstRow + kRows / 2), HasSubstr(" 0.00|"));
}

TEST(PlotOf, InUnicodeDrawsForwardAsALineAndBackwardAsRings) {
  CurveText curve = Steps();
  curve.forward = {1.0, 1.0, 1.0, 1.0, 1.0};
  const std::string text = PlotOf(curve, Letters::kUnicode);
  std::string line;
  for (std::size_t k = 0; k < kPlaces; ++k) line += "⠉";  // both upper dots: level and unbroken
  EXPECT_THAT(text, HasSubstr("│" + line + "\n"));
  EXPECT_THAT(text, HasSubstr("│○"));
  for (const std::string& of : test::LinesOf(text)) EXPECT_LE(WidthOf(of), 80u);
}

TEST(PlotOf, BreaksTheLineWhereAPlaceIsMissing) {
  CurveText curve = Steps();
  curve.backward.clear();
  curve.forward = {1.0, 1.0, std::nan(""), 1.0, 0.0};
  const std::string text = PlotOf(curve, Letters::kUnicode);
  // Places 0 to 1 are dots 0 to 34, 17 letters and a half; then nothing up to dot 101, in letter 50.
  EXPECT_THAT(test::LinesOf(text).at(kFirstRow), HasSubstr("⠉⠁" + std::string(32, ' ') + "⠈"));
  EXPECT_THAT(text, Not(HasSubstr("both")));
}

TEST(PlotOf, OfALevelLineIsInTheMiddle) {
  CurveText curve = Steps();
  curve.backward.clear();
  curve.forward = {3.0, 3.0, 3.0, 3.0, 3.0};
  EXPECT_EQ(At(test::LinesOf(PlotOf(curve, Letters::kAscii)), kRows / 2, 0), '>');
}

TEST(PlotOf, OfFewerThanTwoPlacesIsNothing) {
  CurveText curve;
  EXPECT_EQ(PlotOf(curve, Letters::kAscii), "");
  curve.forward = {1.0, std::numeric_limits<double>::quiet_NaN()};
  EXPECT_EQ(PlotOf(curve, Letters::kAscii), "");
}

TEST(TextTable, AlignsColumnsAndBreaksTheWidestAtWordsKeepingAWholeOneAsLongAsOthersCanGiveWay) {
  EXPECT_KEPT(TextTable({{"cause"}, {"share", true}}, {{"play\n  lost motion", "97 %"}, {"drift", "3 %"}}, 80));
  EXPECT_KEPT(TextTable({{"a"}, {"b"}}, {{"name\n  one two three four five six", "1"}}, 20));
  const std::string title = "some thirty letters of a title of";
  EXPECT_KEPT(TextTable({{"a"}, {"b", false, true}}, {{title, "1.0000000 ± 0.0000001 µm"}}, 56));
}

TEST(TextTable, LeavesOutColumnsWithoutCells) {
  EXPECT_EQ(TextTable({{"a"}, {"b"}}, {{"1"}}, 80), "a\n-\n1\n");
  EXPECT_EQ(TextTable({{"a"}}, {}, 80), "");
}

TEST(TextTable, CountsCharactersAndNotBytes) {
  EXPECT_EQ(WidthOf("10 µm ●"), 7u);
  EXPECT_KEPT(TextTable({{"a"}, {"b"}}, {{"µµµ", "1"}, {"mmm", "2"}}, 80));
}

TEST(Paragraph, HangsBehindItsHead) {
  EXPECT_EQ(Paragraph("! ", "one two three", 2, 9), "! one two\n  three\n");
}

using units::arcsec, units::deg;

CompensationTable Quarters() {
  return {{0.0, 90.0 * deg, 180.0 * deg, 270.0 * deg}, {3.6 * arcsec, -7.2 * arcsec, 0.0, 1.8 * arcsec}};
}

TEST(ControllerTable, GivesLinuxCncTheActualPositions) {
  // Trim = nominal - actual is what is added: 3.6 arcsec = 0.001 deg too little at 0 deg.
  EXPECT_EQ(ControllerTable("linuxcnc", Quarters(), "C", {"a comment would end the reading"}),
            "0.000000000 -0.001000000 -0.001000000\n"
            "90.000000000 90.002000000 90.002000000\n"
            "180.000000000 180.000000000 180.000000000\n"
            "270.000000000 269.999500000 269.999500000\n"
            "360.000000000 359.999000000 359.999000000\n");
}

TEST(ControllerTable, GivesTwinCatAModuloTurnHeidenhainItsColumnsAndNamesTheFormsThereAre) {
  EXPECT_KEPT(ControllerTable("twincat", Quarters(), "C", {"of a turntable"}));
  EXPECT_KEPT(ControllerTable("heidenhain", Quarters(), "B", {}));
  EXPECT_KEPT(MessageOf([] { ControllerFormNamed("fanuc"); }));
}

TEST(ControllerTable, StartsAtZeroWhereTheTableDoesNot) {
  const CompensationTable table{{90.0 * deg, 270.0 * deg}, {3.6 * arcsec, 7.2 * arcsec}};
  EXPECT_THAT(ControllerTable("linuxcnc", table, "C", {}), HasSubstr("0.000000000 -0.001500000 -0.001500000\n9"));
}

TEST(ControllerTable, RefusesMoreEntriesThanTheControllerTakes) {
  CompensationTable table;
  for (int i = 0; i < 256; ++i) {
    table.position_rad.push_back(i * deg);
    table.correction_rad.push_back(0.0);
  }
  for (const char* form : {"linuxcnc", "heidenhain"})
    EXPECT_KEPT(MessageOf([&] { ControllerTable(form, table, "C", {}); }));
  EXPECT_NO_THROW(ControllerTable("twincat", table, "C", {}));
}

TEST(OrderRanges, JoinsNeighbours) {
  EXPECT_EQ(OrderRanges({1, 2, 3, 18, 90, 91}), "orders 1-3, 18, 90-91");
  EXPECT_EQ(OrderRanges({7}), "order 7");
}

TEST(CurveScore, TellsTheLargestErrorOfEitherSignAndLeavesOutWhatIsNotKnown) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  const CurveScore curve{"turntable", "ez_arcsec", "position_deg", {0.0, 90.0, 180.0, 270.0}, {1.0, -2.5, 0.5, kNaN},
                         {0.5, 0.5, 0.5, 0.5}, {0.0, 0.5, 0.0, 0.0}};
  const nlohmann::json score = ToJson({curve})["turntable"]["ez"];
  EXPECT_DOUBLE_EQ(score["worst_error_arcsec"].get<double>(), 3.0);
  EXPECT_NEAR(score["rms_error_arcsec"].get<double>(), std::sqrt((1.0 + 9.0 + 0.25) / 3.0), 1e-12);
}

}  // namespace
}  // namespace twinbench::report
