#include "twin/report/page/readings_page.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "tests/report_page/blocks.h"
#include "twin/report/page/volumetric.h"

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

}  // namespace
}  // namespace twinbench::report
