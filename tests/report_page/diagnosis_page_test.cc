#include "twin/report/page/diagnosis_page.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "tests/report_page/blocks.h"
#include "twin/report/page/causes.h"

namespace twinbench::report {
namespace {

using nlohmann::json, testing::Contains, testing::ElementsAre;

const json kDiagnosis = json::parse(R"({
  "verdict": "tie", "alarm_p": 0.0004,
  "causes": [
    {"effect": "eccentricity", "where": "", "probability": 0.5, "next_measurement": "turn the device by 90 degrees",
     "parameters": {"amplitude_arcsec": {"value": 12.345, "u": 0.5, "unit": "arcsec"}},
     "indistinguishable_from": [{"effect": "tilt", "where": "x", "overlap": 0.99}]},
    {"effect": "tilt", "where": "x", "probability": 0.45, "parameters": {}, "indistinguishable_from": [], "next_measurement": ""}],
  "unknown": {"probability": 0.05, "signature": ""},
  "detectable": [{"effect": "tilt", "where": "x", "parameter": "tilt", "smallest": 0.25, "unit": "mrad"}],
  "invisible": [{"effect": "grating_form", "where": "sphere", "could_bias": "nothing"}],
  "plots": {"unit": "um", "against": {"dwell_s": {"a": {"x": [1, 2], "before": [0.1, 0.1], "after": [0, 0], "u": [0.1, 0.1], "n": [5, 5]},
                                                  "b": {"x": [1, 2], "before": [0.5, -0.5], "after": [0, 0.1], "u": [0.1, 0.1], "n": [5, 5]}}},
            "maps": {"a": {"position": [0, 1, 2], "setup": [3], "before": [[1, null, 3]], "after": [[0, 0, 0]]}}}})");

template <class Block>
Block BlockIn(const std::vector<PageSection>& sections, const std::string& title) {
  for (const Block& block : test::BlocksOf<Block>(sections)) {
    if (block.title == title) return block;
  }
  throw std::runtime_error("no block " + title);
}

TEST(VerdictOf, SaysATieWithAllItsMembers) {
  EXPECT_EQ(VerdictOf(kDiagnosis).text, "Ambiguous: eccentricity or tilt at x");
  EXPECT_EQ(VerdictOf({{"verdict", "none"}}).tone, VerdictTone::kGood);
  EXPECT_EQ(VerdictOf({{"verdict", "named"}, {"in_words", "Cause identified: roll 3 um\nmore"}}).text, "Cause identified: roll 3 µm");
}

TEST(DiagnosisSections, StateEveryCauseWithItsSizeAndProbability) {
  const std::vector<PageSection> sections = DiagnosisSections(kDiagnosis);
  const Figure& causes = BlockIn<Figure>(sections, "Causes");
  EXPECT_THAT(causes.categories, ElementsAre("eccentricity or tilt at x", "unmodelled effect"));
  EXPECT_THAT(causes.series[0].y, ElementsAre(0.95, 0.05));
  EXPECT_THAT(BlockIn<PageTable>(sections, "Sizes").rows[0],
              ElementsAre("eccentricity or tilt at x", "amplitude 12.35 ± 0.50 arcsec", "", "95 %", "turn the device by 90 degrees"));
}

TEST(DiagnosisSections, RankCausesByWhatTheyExplain) {
  const json causes = json::parse(R"([{"effect": "tone", "where": "", "probability": 0.99, "parameters": {"phase": {"value": -1, "u": 9, "lower": -1, "upper": 1, "unit": "1"}}},
                                      {"effect": "drift", "where": "", "probability": 0.90, "parameters": {"rate": {"value": 3, "u": 0, "unit": "deg"}}}])");
  const std::vector<CauseGroup> groups = GroupsOf({{"causes", causes}, {"plots", {{"share", {0.2, 0.7}}}}});
  ASSERT_EQ(groups.size(), 2u);
  EXPECT_EQ(groups[0].name, "drift");
  EXPECT_EQ(groups[0].size, "rate 3°");
  EXPECT_EQ(groups[1].size, "") << "the readings do not determine it";
  EXPECT_EQ(GroupsOf({{"causes", causes}})[0].name, "tone") << "where no share is stated, by probability";
}

TEST(DiagnosisSections, NameTheDoublesOfACause) {
  EXPECT_THAT(BlockIn<PageTable>(DiagnosisSections(kDiagnosis), "Indistinguishable in this run (aliased)").rows,
              ElementsAre(ElementsAre("eccentricity", "tilt at x", "0.99")));
}

TEST(DiagnosisSections, SayWhatIsSeenFromWhichSizeOnAndWhatIsNot) {
  const std::vector<PageSection> sections = DiagnosisSections(kDiagnosis);
  EXPECT_THAT(BlockIn<PageTable>(sections, "Smallest detectable sizes").rows,
              Contains(ElementsAre("tilt at x", "tilt", "0.25", "mrad")));
  EXPECT_THAT(BlockIn<PageTable>(sections, "Not observable in this run").rows,
              Contains(ElementsAre("grating_form at sphere", "nothing")));
}

TEST(DiagnosisSections, ShowTheLoudestResidualFirstAndAllOthersToo) {
  const std::vector<PageSection> sections = DiagnosisSections(kDiagnosis);
  const PageChoice& choice = BlockIn<PageChoice>(sections, "Residuals before and after the extension");
  EXPECT_THAT(choice.answers, ElementsAre(ElementsAre("dwell", "b"), ElementsAre("dwell", "a"),
                                          ElementsAre("position in mounting 3", "a")));
  EXPECT_THAT(choice.figures[0].series[0].y, ElementsAre(0.5, -0.5));
  EXPECT_EQ(choice.figures[0].series[0].role, SeriesRole::kBefore);
  EXPECT_EQ(choice.figures[0].x.unit, "s");
  EXPECT_EQ(choice.figures[0].y.unit, "µm");
}

}  // namespace
}  // namespace twinbench::report
