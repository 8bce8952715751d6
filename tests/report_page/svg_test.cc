#include "twin/report/page/svg.h"

#include <gmock/gmock.h>

#include <cmath>
#include <regex>

namespace twinbench::report {
namespace {

using testing::HasSubstr, testing::Not;

std::size_t CountOf(const std::string& text, const std::string& what) {
  std::size_t n = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++n;
  return n;
}

Figure CircleOf(double value) {
  FigureSeries series{"estimate", SeriesRole::kEstimate, {0, 90, 180, 270}, {value, value, value, value}, {}};
  return {FigureForm::kAngle, "a curve", "", {"position", "deg"}, {"ez", "arcsec"}, {series}};
}

TEST(SvgOf, AConstantErrorIsACircleAboutTheMiddle) {
  const std::string svg = SvgOf(CircleOf(2.0));
  // The axis goes from -4 to 3 on 222 px: 2 is 190.3 px from the middle at (320, 322).
  EXPECT_THAT(svg, HasSubstr("M510.3 322.0L320.0 131.7L129.7 322.0L320.0 512.3L510.3 322.0"));
}

TEST(SvgOf, TextIsEscaped) {
  Figure figure = CircleOf(1.0);
  figure.title = "<script>&";
  figure.series[0].name = "\"><b>";
  const std::string svg = SvgOf(figure);
  EXPECT_THAT(svg, Not(HasSubstr("<script>")));
  EXPECT_THAT(svg, HasSubstr("&lt;script&gt;&amp;"));
  EXPECT_THAT(svg, Not(HasSubstr("<b>")));
}

TEST(SvgOf, ABarIsAsHighAsItsValue) {
  FigureSeries series{"a", SeriesRole::kEstimate, {1, 2}, {1.0, 0.5}, {}};
  const std::string svg = SvgOf({FigureForm::kBars, "t", "", {"order", ""}, {"amplitude", "um"}, {series}});
  // The axis from 0 to 1 is 440 - 56 - 72 = 312 px high.
  EXPECT_THAT(svg, HasSubstr("height=\"312.0\""));
  EXPECT_THAT(svg, HasSubstr("height=\"156.0\""));
}

TEST(SvgOf, AGapIsNotDrawnOver) {
  FigureSeries series{"a", SeriesRole::kEstimate, {0, 1, 2, 3, 4}, {0.0, 1.0, std::nan(""), 1.0, 0.0}, {}};
  const std::string svg = SvgOf({FigureForm::kLine, "t", "", {"x", "s"}, {"y", "um"}, {series}});
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
  const std::regex curve("<path d=\"M[^M\"]*M[^M\"]*\" fill=\"none\" stroke=\"#0b62a8\"");
  EXPECT_TRUE(std::regex_search(svg, curve));
}

TEST(SvgPictures, NameAFileForEveryFigureAndTheFirstOfAChoice) {
  Page page;
  PageChoice choice{"c", "", {"q"}, {{"a"}, {"b"}}, {CircleOf(1.0), CircleOf(2.0)}};
  page.sections = {{"Errors", "", {CircleOf(1.0), PageText{"no", "figure"}, choice}}};
  const auto pictures = SvgPictures(page);
  ASSERT_EQ(pictures.size(), 2u);
  EXPECT_EQ(pictures[0].first, "errors-a-curve.svg");
  EXPECT_EQ(CountOf(pictures[0].second, "</svg>"), 1u);
}

}  // namespace
}  // namespace twinbench::report
