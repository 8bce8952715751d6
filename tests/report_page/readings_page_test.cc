#include <regex>

#include "tests/report_page/blocks.h"
#include "twin/report/page/curves.h"
#include "twin/report/page/readings_page.h"
#include "twin/report/page/svg.h"

namespace twinbench::report {
namespace {

using ::testing::ElementsAre;

std::vector<Reading> TwoSetups() {
  std::vector<Reading> readings(4);
  for (int k = 0; k < 4; ++k) {
    Reading& r = readings[static_cast<std::size_t>(k)];
    r.reading = k;
    r.setup = k / 2;
    r.target_rad = 0.1 * k;
    r.mean_V = {0.5 * k, -0.25 * k, 1.0 * k, 2.0 * k};
    r.std_V = {0.1, 0.2, 0.3, 0.4};
  }
  return readings;
}

TEST(ReadingsSection, ATrackIsThePlacesOfASpotSetUpBySetUp) {
  const PageSection section = ReadingsSection(TwoSetups(), "rotary_4dof");
  const std::vector<Figure> tracks = test::BlocksOf<Figure>({section});
  ASSERT_EQ(tracks.size(), 2u);
  EXPECT_EQ(tracks[0].title, "Track on psd a");
  EXPECT_EQ(tracks[0].y.unit, "V");
  ASSERT_EQ(tracks[0].series.size(), 2u);
  EXPECT_EQ(tracks[0].series[1].name, "mounting 1");
  EXPECT_THAT(tracks[0].series[1].x, ElementsAre(1.0, 1.5));
  EXPECT_THAT(tracks[0].series[1].y, ElementsAre(-0.5, -0.75));
}

TEST(ReadingsSection, ColumnsAreThoseThatChangeInTheirUnits) {
  const PageSection section = ReadingsSection(TwoSetups(), "rotary_4dof");
  const auto& columns = std::get<PageColumns>(section.blocks.at(0));
  const auto named = [&](const std::string& name) {
    return std::find_if(columns.columns.begin(), columns.columns.end(), [&](const auto& c) { return c.name == name; });
  };
  ASSERT_NE(named("psd b y"), columns.columns.end());
  EXPECT_THAT(named("psd b y")->values, ElementsAre(0.0, 2.0, 4.0, 6.0));
  EXPECT_EQ(named("temperature"), columns.columns.end());  // nowhere available
  EXPECT_EQ(columns.columns[static_cast<std::size_t>(columns.group)].name, "mounting");
}

TEST(ReadingsSection, OfABenchThatNobodyKnowsThereIsNothing) {
  EXPECT_TRUE(ReadingsSection(TwoSetups(), "no such bench").blocks.empty());
}

TEST(VolumetricColumns, ErrorsInSpaceHaveTheirPlaces) {
  const nlohmann::json results = {{"error_map", {{"x_mm", {1, 2}}, {"y_mm", {3, 4}}, {"z_mm", {5, 6}}, {"dx_um", {0.5, -0.5}}, {"k", {1, 2, 3}}}}};
  const std::vector<PageColumns> columns = VolumetricColumns(results);
  ASSERT_EQ(columns.size(), 1u);
  ASSERT_EQ(columns[0].columns.size(), 4u);
  EXPECT_EQ(columns[0].columns[3].name, "dx");
  EXPECT_EQ(columns[0].colour, 3);
}

using testing::HasSubstr, testing::Not;

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
  EXPECT_THAT(pictures[0].second, HasSubstr("</svg>"));
  EXPECT_EQ(pictures[0].second.find("</svg>"), pictures[0].second.rfind("</svg>")) << "one picture a file";
}

}  // namespace
}  // namespace twinbench::report
