#include "tests/report_page/blocks.h"
#include "twin/report/page/causes.h"
#include "twin/report/page/diagnosis_page.h"
#include "twin/report/page/investigation_page.h"
#include "twin/report/page/plan_page.h"

namespace twinbench::report {
namespace {

using nlohmann::json, testing::Contains, testing::ElementsAre;

const json kDiagnosis = test::JsonOf("diagnosis.json");

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

TEST(RunPage, HasTheErrorsRightBehindTheirCauses) {
  const auto titles = [](const json& results) {
    std::vector<std::string> all;
    for (const PageSection& section : RunPage({"run", "", {}, "", {}}, results, {}).sections) all.push_back(section.title);
    return all;
  };
  json results = {{"diagnosis", kDiagnosis}, {"table", {{"position_deg", {0, 90, 180}}, {"ez_arcsec", {1.5, 0.2, -2.5}}}}};
  EXPECT_THAT(titles(results), testing::IsSupersetOf({"Diagnosis", "Errors", "Residuals", "Detectability"}));
  EXPECT_EQ(titles(results).at(0), "Diagnosis");
  EXPECT_EQ(titles(results).at(1), "Errors");
  const json one = {{"order", 1}, {"unit", "um"}, {"cosine", 3.0}, {"amplitude", 3.0}};
  results = {{"errors", {{"XOC", {{"value", 3.0}, {"u", 0.1}, {"unit", "um"}}}}}, {"component_errors", {{"EXA", {one}}}}};
  EXPECT_EQ(titles(results).at(0), "Results") << "one order is no spectrum";
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

TEST(DiagnosisSections, NameTheDoublesOfACauseAndFromWhichSizeOnOneIsSeen) {
  const std::vector<PageSection> sections = DiagnosisSections(kDiagnosis);
  EXPECT_THAT(BlockIn<PageTable>(sections, "Indistinguishable in this run (aliased)").rows,
              ElementsAre(ElementsAre("eccentricity", "tilt at x", "0.99")));
  EXPECT_THAT(BlockIn<PageTable>(sections, "Smallest detectable sizes").rows,
              Contains(ElementsAre("tilt at x", "tilt", "0.25", "mrad")));
  EXPECT_THAT(BlockIn<PageTable>(sections, "Not observable in this run").rows,
              Contains(ElementsAre("grating_form at sphere", "zero of a mounting up to 0.3 µm")));
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

const json kPlan = test::JsonOf("plan.json");

TEST(PlanPage, ComparesTheRunsOrderByOrder) {
  const std::vector<Figure> figures = test::BlocksOf<Figure>(PlanPage({}, kPlan).sections);
  ASSERT_EQ(figures.size(), 2u);
  EXPECT_EQ(figures[0].title, "u of target ez");
  ASSERT_EQ(figures[0].series.size(), 2u);
  EXPECT_THAT(figures[0].series[0].y, ElementsAre(0.01, 0.02));
  EXPECT_THAT(figures[0].series[1].y, ElementsAre(0.03, 0.04));
  EXPECT_THAT(figures[1].categories, ElementsAre("two more mountings"));
}

TEST(PlanPage, SaysWhichRunToMakeAndWhatMayBeMistaken) {
  const Page page = PlanPage({}, kPlan);
  EXPECT_EQ(page.title, "Turntable");
  EXPECT_EQ(page.verdict, "Most information per minute: two more mountings.");
  std::vector<std::vector<std::string>> rows;
  for (const PageTable& table : test::BlocksOf<PageTable>(page.sections)) rows.insert(rows.end(), table.rows.begin(), table.rows.end());
  EXPECT_THAT(rows, Contains(ElementsAre("a at x", "b", "0.002", "µm/K")));
  EXPECT_THAT(rows, Contains(ElementsAre("c, d at y")));
  EXPECT_THAT(rows, Contains(ElementsAre("target ez", "arcsec", "0.05", "0.1")));
}

TEST(PlanPage, BeginsWithTheProgrammeAndTheUncertaintyAfterIt) {
  json plan = kPlan;
  plan["programme"] = {{"u_after_over_before", {{{"name", "separation.target.ez_arcsec"}, {"ratio", 0.5}}}},
                       {"d_optimal", {{"runs", {{{"name", "best"}, {"times", 2}}}}}}};
  const Page page = PlanPage({}, plan);
  EXPECT_EQ(page.verdict, "Best runs to add: 2 x best. Most information per minute: two more mountings.");
  const std::vector<PageTable> tables = test::BlocksOf<PageTable>(page.sections);
  EXPECT_THAT(tables.front().columns, ElementsAre("result", "unit", "as is", "other", "with the programme after it"));
  EXPECT_THAT(tables.front().rows.front(), ElementsAre("target ez", "arcsec", "0.05", "0.1", "0.025"));
}

TEST(InvestigationPage, ShowsProbabilitiesOverTheRuns) {
  const json investigation = test::JsonOf("investigation.json");
  const Page page = InvestigationPage({}, investigation, {"01-first/report.html"});
  EXPECT_EQ(page.verdict, "Not resolvable on this bench: a 80 %, b 18 %");
  const std::vector<Figure> figures = test::BlocksOf<Figure>(page.sections);
  ASSERT_EQ(figures.size(), 3u);
  EXPECT_THAT(figures[0].series[0].y, ElementsAre(0.5, 0.8));
  EXPECT_EQ(figures[0].y.high, 1.0) << "a probability is seen on the whole of its axis";
  EXPECT_EQ(figures[0].series[2].name, "not in the catalogue");
  EXPECT_THAT(figures[0].series[2].x, ElementsAre(2));
  EXPECT_THAT(figures[1].series[1].y, ElementsAre(0, 1.25));
  EXPECT_EQ(page.tiles[0].value, "a, 80 %");
  EXPECT_EQ(page.tiles[0].note, "width 0.0040 ± 0.0010°");
  const std::vector<PageTable> tables = test::BlocksOf<PageTable>(page.sections);
  EXPECT_THAT(tables[0].links, ElementsAre("01-first/report.html"));
  EXPECT_EQ(tables[1].rows[0][1], "width 0.0040 ± 0.0010°");
  EXPECT_EQ(figures[2].note, "target.ez 0.1arcsec, met");
}

}  // namespace
}  // namespace twinbench::report
