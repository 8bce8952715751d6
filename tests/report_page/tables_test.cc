#include "tests/report_page/blocks.h"
#include "twin/report/page/named_numbers.h"
#include "twin/report/page/page_json.h"
#include "twin/report/page/tables.h"

namespace twinbench::report {
namespace {

using nlohmann::json, testing::Contains, testing::ElementsAre;

const json kEvaluated = test::JsonOf("evaluated.json");

TEST(ValueTable, GivesValuesWithUnitAndUncertaintyOfTheBudgetWhereThereIsOne) {
  const PageTable table = ValueTable(kEvaluated, {});
  EXPECT_THAT(table.columns, ElementsAre("quantity", "value", "unit", "u", "k", "U"));
  EXPECT_THAT(table.rows, Contains(ElementsAre("calibration roll psd a", "0.06", "mrad", "0.20", "1.972", "0.39")));
  EXPECT_THAT(table.rows, Contains(ElementsAre("errors machine scale x", "12.35", "µm/m", "0.50", "", "")));
}

TEST(ValueTable, ShowsTruthBesideAValueThatWasScored) {
  const json score = {{"values", {{"calibration.roll_mrad.psd_a", {{"value", {0.06}}, {"u", {0.2}}, {"truth", {0.11}}}}}}};
  EXPECT_THAT(ValueTable(kEvaluated, score).rows,
              Contains(ElementsAre("calibration roll psd a", "0.06", "mrad", "0.20", "1.972", "0.39", "0.11")));
}

TEST(BudgetFigure, StacksTheSharesOfEverySourceBesideWhatIsNotSeparable) {
  const Figure figure = BudgetFigure(kEvaluated);
  EXPECT_THAT(figure.categories, ElementsAre("calibration roll mrad psd a", "ez"));
  ASSERT_EQ(figure.series.size(), 2u);
  EXPECT_EQ(figure.series[0].name, "drift");
  EXPECT_THAT(figure.series[0].y, ElementsAre(0.25, 0.0));
  EXPECT_THAT(figure.series[1].y, ElementsAre(0.75, 1.0));
  EXPECT_THAT(NotSeparableTable(kEvaluated).rows, ElementsAre(ElementsAre("target dx", "nobody reads it")));
}

TEST(ObjectTables, HaveARowAnObjectWithItsMeasuredValues) {
  const std::vector<PageTable> tables = ObjectTables(kEvaluated);
  ASSERT_EQ(tables.size(), 1u);
  EXPECT_EQ(tables[0].title, "Mountings");
  EXPECT_THAT(tables[0].columns, ElementsAre("setup", "offset x [µm]"));
  EXPECT_THAT(tables[0].rows[0], ElementsAre("0", "4.772 ± 0.018"));
}

TEST(ObjectTables, ShowValuesInGroupsWithTheUnitsOfTheirKeysInOneColumn) {
  const nlohmann::json results = nlohmann::json::parse(R"({"iso230_7": [
    {"motion": "tilt_fixed_x", "asynchronous_motions": 2, "values": {"total": {"value_arcsec": 9.5123, "u_arcsec": 0.12}, "synchronous": {"value_arcsec": 8.0, "u_arcsec": null}}},
    {"motion": "radial_fixed_y", "values": {"total": {"value_um": 3.0, "u_um": 0.5}}}]})");
  const std::vector<PageTable> tables = ObjectTables(results);
  ASSERT_EQ(tables.size(), 1u);
  EXPECT_THAT(tables[0].columns, ElementsAre("motion", "asynchronous motions", "synchronous", "total"));
  EXPECT_THAT(tables[0].rows[0], ElementsAre("tilt_fixed_x", "2", "8 arcsec", "9.51 ± 0.12 arcsec"));
  EXPECT_THAT(tables[0].rows[1], ElementsAre("radial_fixed_y", "", "", "3.00 ± 0.50 µm"));
}

TEST(ObjectTables, ShowAnObjectThatIsAValueByItsWordsAndRounded) {
  const json results = {{"ranked", {{{"setup", 0}, {"error", "cubic"}, {"key", "bar.cubic_per_mm2"}, {"value", 2.0712}, {"u", 0.34}, {"unit", "per_mm2"}}}}};
  const std::vector<PageTable> tables = ObjectTables(results);
  ASSERT_EQ(tables.size(), 1u);
  EXPECT_THAT(tables[0].columns, ElementsAre("setup", "error", "value"));
  EXPECT_THAT(tables[0].rows[0], ElementsAre("0", "cubic", "2.07 ± 0.34 mm⁻²"));
}

TEST(ObjectTables, BeginWithWhatARowIsOf) {
  const json results = {{"targets", {{{"mean_arcsec", 1.0}, {"position_deg", 0.0}, {"setup", 0}}}}};
  EXPECT_THAT(ObjectTables(results).at(0).columns, ElementsAre("setup", "position [deg]", "mean [arcsec]"));
}

TEST(ObjectTables, LieOnTheirSideWhereFewRowsHaveMoreColumnsThanAPageHolds) {
  json row = {{"setup", 1}};
  for (char key = 'a'; key < 'k'; ++key) row[std::string(1, key)] = key - 'a';
  const PageTable table = ObjectTables({{"vdi3441", {row}}}).at(0);
  EXPECT_EQ(table.title, "VDI/DGQ 3441");
  EXPECT_THAT(table.columns, ElementsAre("setup", "1"));
  ASSERT_EQ(table.rows.size(), 10u);
  EXPECT_THAT(table.rows.back(), ElementsAre("j", "9"));
}

TEST(NumberText, HasTwoDigitsOfItsUncertaintyAndTheLongestUnitAtTheEndOfItsName) {
  EXPECT_EQ(NumberText(1234.5678, 0.0123), "1234.568");
  EXPECT_EQ(NumberText(1234.5678, 250.0), "1230");
  EXPECT_EQ(NumberText(0.5, 0.0), "0.5");
  EXPECT_EQ(MeasuredText(-1.26e11, 6e10, "per_m4"), "(−1.26 ± 0.60)e11 m⁻⁴");
  EXPECT_EQ(NameAndUnit("expansion_um_m_K").unit, "µm/m/K");
  EXPECT_EQ(NameAndUnit("ez_arcsec").name, "ez");
  EXPECT_EQ(NameAndUnit("dwell_s").unit, "s");
  EXPECT_EQ(NameAndUnit("setups").unit, "");
  EXPECT_EQ(NameAndUnit("score.ez_arcsec[]").unit, "arcsec");
}

using testing::HasSubstr, testing::Not;

constexpr const char* kMarkup = "<title><!--TITLE--></title><script type=\"application/json\"><!--DATA--></script>";
constexpr const char* kEvil = "</script><script>alert(1)</script><!--<script>&\"'";

Page EvilPage() {
  return {kEvil, kEvil, kEvil, VerdictTone::kPlain, {{kEvil, kEvil, {PageText{kEvil, kEvil}, PageTable{kEvil, {kEvil}, {{kEvil}}}}}}};
}

TEST(PageHtml, TextOfAScenarioEndsNoElementBeginsNoneAndComesBackAsItWas) {
  const std::string html = PageHtml(EvilPage(), kMarkup);
  // Of all that is written only the markup's own four tags have an angle bracket.
  EXPECT_EQ(std::count(html.begin(), html.end(), '<'), 4);
  EXPECT_EQ(std::count(html.begin(), html.end(), '>'), 4);
  EXPECT_THAT(html, Not(HasSubstr("alert(1)</script>")));
  const std::size_t begin = html.find("json\">") + 6;
  const json data = json::parse(html.substr(begin, html.find("</script>") - begin));
  EXPECT_EQ(data["title"], kEvil);
  EXPECT_EQ(data["sections"][0]["blocks"][1]["rows"][0][0], kEvil);
}

TEST(PageHtml, ATitleThatLooksLikeTheMarkOfTheDataIsText) {
  Page page;
  page.title = "<!--DATA-->";
  page.subtitle = "<!--TITLE-->";
  const std::string html = PageHtml(page, kMarkup);
  EXPECT_THAT(html, HasSubstr("<title>&lt;!--DATA--&gt;</title>"));
}

TEST(PageJson, KeepsTheBitsOfANumberAndNullWhereThereIsNone) {
  FigureSeries series{"s", SeriesRole::kTruth, {0.0, 1.0}, {0.1 + 0.2, std::nan("")}, {}};
  Page page;
  page.sections = {{"a", "", {Figure{FigureForm::kAngle, "t", "", {"x", "deg"}, {"y", "um"}, {series}}}}};
  const json figure = json::parse(PageJson(page))["sections"][0]["blocks"][0];
  EXPECT_EQ(figure["series"][0]["y"][0].get<double>(), 0.1 + 0.2);
  EXPECT_TRUE(figure["series"][0]["y"][1].is_null());
  EXPECT_EQ(figure["series"][0]["role"], "truth");
  EXPECT_FALSE(figure["series"][0].contains("u"));
}

TEST(PageJson, ANameThatIsNoUtf8DoesNotKeepTheRestFromBeingShown) {
  Page page;
  page.title = "bad \xff byte";
  page.subtitle = "good";
  EXPECT_EQ(json::parse(PageJson(page))["subtitle"], "good");
}

}  // namespace
}  // namespace twinbench::report
