#include "twin/campaign/campaign_page.h"

#include <numeric>

#include "tests/core/input_error.h"

namespace twinbench::campaign {
namespace {

using testing::ElementsAre, testing::Pair;

constexpr const char* kStudy = R"(scenario_text = '''
bench = "encoder_comparison"
'''
trials = 3
[[vary]]
key = "device.noise_deg"
values = [0.001, 0.002]
)";

/// A table of six trials whose error is `trial - 2.5` in units of u.
Table TableIn(const std::string& path) {
  const Study study = ParseStudy(kStudy, "study.toml", ".");
  Table table = Table::Create(path, "1", study);
  for (int trial = 0; trial < 6; ++trial) {
    TrialRow row{trial, "", "", {{"mean_arcsec", 10.0 + trial, 2.0, 2.0 * (trial - 2.5)}}};
    table.Write(row, 1, {trial < 3 ? "0.001" : "0.002"});
  }
  return table;
}

TEST(CampaignPage, SaysWhetherUncertaintiesHoldAndPlotsEveryTrial) {
  twinbench::TemporaryFolder folder;
  const Table trials = TableIn(folder.File("t.sqlite"));
  const report::PageTile tile = CoverageTile(SummaryOf(trials));
  EXPECT_EQ(tile.value, "66.7 %");  // |trial - 2.5| of 0.5 and 1.5 are within 1.96
  EXPECT_EQ(tile.tone, report::VerdictTone::kBad);
  const std::vector<report::PageSection> sections = CampaignSections(trials, SummaryOf(trials));
  ASSERT_EQ(sections.size(), 2u);
  const auto& table = std::get<report::PageTable>(sections[0].blocks.at(0));
  // Mean of 10 to 15; four of six errors are within 1.96 u.
  EXPECT_THAT(table.rows.at(0), ElementsAre("mean", "arcsec", "6", "12.5", "1.871", "2", "0", "66.7 %"));
  const auto& histograms = std::get<report::PageChoice>(sections[1].blocks.at(0));
  ASSERT_THAT(histograms.answers, ElementsAre(ElementsAre("mean_arcsec", "error / u"), ElementsAre("mean_arcsec", "value")));
  const std::vector<double>& counts = histograms.figures[1].series[0].y;
  EXPECT_EQ(std::accumulate(counts.begin(), counts.end(), 0.0), 6.0);
  EXPECT_EQ(histograms.figures[0].series[1].role, report::SeriesRole::kExpected);
  const auto& scatters = std::get<report::PageChoice>(sections[1].blocks.at(1));
  EXPECT_THAT(scatters.figures.at(0).series.at(0).x, ElementsAre(0.001, 0.001, 0.001, 0.002, 0.002, 0.002));
  EXPECT_THAT(scatters.figures[0].series[0].y, ElementsAre(10, 11, 12, 13, 14, 15));
}

TEST(ResultSummary, AMeanOfNumbersThatCancelIsNone) {
  EXPECT_EQ((ResultSummary{.mean = -3.553e-16, .sd = 0.2}).ShownMean(), 0.0);
  EXPECT_EQ((ResultSummary{.mean = -3.553e-16, .sd = 1e-15}).ShownMean(), -3.553e-16);
}

}  // namespace
}  // namespace twinbench::campaign
