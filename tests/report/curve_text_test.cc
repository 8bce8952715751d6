#include "twin/report/curve_text.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "tests/report/page_lines.h"
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

TEST(PlotOf, LabelsBothAxesWithTheirEnds) {
  const auto lines = test::LinesOf(PlotOf(Steps(), Letters::kAscii));
  EXPECT_THAT(lines.at(kFirstRow), HasSubstr("1.00|"));
  EXPECT_THAT(lines.at(kFirstRow + kRows - 1), HasSubstr("-1.00|"));
  const std::string& axis = lines.at(kFirstRow + kRows + 1);
  EXPECT_EQ(axis.substr(kFrame, 2), "0 ");
  EXPECT_EQ(axis.substr(axis.size() - 4), " 360");
  EXPECT_THAT(lines.at(kFirstRow + kRows + 2), HasSubstr("angle [deg]"));
  EXPECT_THAT(lines.back(), HasSubstr("> forward   < backward   x both"));
}

TEST(PlotOf, DoesNotLabelZeroWithASign) {
  CurveText curve = Steps();
  for (double& value : curve.forward) value *= 0.999;  // the middle is -0.0005
  EXPECT_THAT(test::LinesOf(PlotOf(curve, Letters::kAscii)).at(kFirstRow + kRows / 2), HasSubstr(" 0.00|"));
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
  curve.x = {1.0, 2.0};
  curve.forward = {1.0, std::numeric_limits<double>::quiet_NaN()};
  EXPECT_EQ(PlotOf(curve, Letters::kAscii), "");
}

}  // namespace
}  // namespace twinbench::report
