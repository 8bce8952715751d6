#include "twin/report/page/page_json.h"

#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>

namespace twinbench::report {
namespace {

using nlohmann::json, testing::HasSubstr, testing::Not;

constexpr const char* kMarkup = "<title><!--TITLE--></title><script type=\"application/json\"><!--DATA--></script>";
constexpr const char* kEvil = "</script><script>alert(1)</script><!--<script>&\"'";

Page EvilPage() {
  return {kEvil, kEvil, kEvil, VerdictTone::kPlain, {{kEvil, kEvil, {PageText{kEvil, kEvil}, PageTable{kEvil, {kEvil}, {{kEvil}}}}}}};
}

TEST(PageHtml, TextOfAScenarioCanNeitherEndAnElementNorBeginOne) {
  const std::string html = PageHtml(EvilPage(), kMarkup);
  // Of all that is written only the markup's own four tags have an angle bracket.
  EXPECT_EQ(std::count(html.begin(), html.end(), '<'), 4);
  EXPECT_EQ(std::count(html.begin(), html.end(), '>'), 4);
  EXPECT_THAT(html, Not(HasSubstr("alert(1)</script>")));
}

TEST(PageHtml, TextComesBackAsItWasWritten) {
  const std::string html = PageHtml(EvilPage(), kMarkup);
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
