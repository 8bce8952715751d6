#include <regex>

#include "tests/core/input_error.h"
#include "tests/support/kept_text.h"
#include "twin/benches/certified_parts.h"
#include "twin/report/certificate/laboratory.h"

namespace twinbench::certificate {
namespace {

using benches::CertifiedPartsOf, nlohmann::json;

Certified Take(const std::string& bench, const json& results) {
  return TakeCertified(results, CertifiedPartsOf(bench, "run"));
}

const CertifiedQuantity* Find(const Certified& certified, const std::string& title) {
  for (const CertifiedQuantity& quantity : certified.quantities)
    if (quantity.title == title) return &quantity;
  return nullptr;
}

std::string WhyNot(const Certified& certified, const std::string& what) {
  for (const LeftOut& one : certified.left_out)
    if (one.what == what) return one.why;
  return "";
}

json OneTable() {
  return json::parse(Contents(TWINBENCH_TEST_DATA "/pages/one_table.json"));
}

TEST(Certified, StatesTheValuesOfTheFileWithTheBudgetsCoverageFactor) {
  const Certified certified = Take("rotary_4dof", OneTable());
  const CertifiedQuantity* ez = Find(certified, "table under test, ez");
  ASSERT_TRUE(ez);
  EXPECT_EQ(ez->values, (std::vector{1.5, -0.25, 3.125}));
  EXPECT_EQ(ez->expanded, (std::vector{2.5 * 0.1, 2.5 * 0.2, 2.5 * 0.3}));
  EXPECT_EQ(ez->dsi_unit, "\\arcsecond");
  EXPECT_FALSE(ez->is_normal);
  ASSERT_EQ(ez->where.size(), 1u);
  EXPECT_EQ(ez->where[0].values, (std::vector{0.0, 120.0, 240.0}));
}

TEST(Certified, LeavesOutWhatHasNoValueOrNoUncertainty) {
  const Certified certified = Take("rotary_4dof", OneTable());
  const CertifiedQuantity* dy = Find(certified, "table under test, dy");
  ASSERT_TRUE(dy);
  EXPECT_EQ(dy->values, std::vector{0.5});
  EXPECT_EQ(dy->where[0].values, std::vector{0.0});
  EXPECT_TRUE(dy->is_normal);  // no budget
  EXPECT_EQ(WhyNot(certified, "table under test, dy"), "1 of 3 values: not available");
}

TEST(Certified, LeavesOutAThingThatIsKnownInASumOnly) {
  json results = OneTable();
  results["separation"]["not_separable"] = {{{"what", "target and reference"}, {"why", "one mounting"}}};
  const Certified certified = Take("rotary_4dof", results);
  EXPECT_TRUE(certified.quantities.empty());
  EXPECT_EQ(WhyNot(certified, "table under test, ez"), "target and reference: one mounting");
}

TEST(Certified, SaysWhichOrderACurveDoesNotHold) {
  json results = OneTable();
  results["separation"]["not_separable"] = {{{"what", "target ex,ez order +1"}, {"why", "it looks like a mounting"}}};
  const Certified certified = Take("rotary_4dof", results);
  EXPECT_EQ(Find(certified, "table under test, ez")->note, "not in these values: order 1, it looks like a mounting");
  EXPECT_EQ(Find(certified, "table under test, dy")->note, "");
}

json TwoOrders() {
  return json::parse(Contents(TWINBENCH_TEST_DATA "/pages/two_orders.json"));
}

TEST(Certified, LeavesOutTheLineOfASumAndTheCurveThatHoldsIt) {
  const Certified certified = Take("encoder_comparison", TwoOrders());
  EXPECT_FALSE(Find(certified, "device, ez"));
  const CertifiedQuantity* amplitude = Find(certified, "orders of the device, amplitude");
  ASSERT_TRUE(amplitude);
  EXPECT_EQ(amplitude->values, std::vector{3.0});
  EXPECT_EQ(amplitude->where[0].values, std::vector{1.0});
}

TEST(Certified, LeavesOutAPhaseKnownToHalfATurn) {
  json results = TwoOrders();
  results.erase("not_separable");
  const Certified certified = Take("encoder_comparison", results);
  EXPECT_EQ(Find(certified, "orders of the device, phase")->values, std::vector{30.0});
  EXPECT_EQ(Find(certified, "device, ez")->values.size(), 2u);
}

TEST(Certified, LeavesOutPointsThatAreInvalidAndUnitsThatNobodyKnows) {
  const json results = json::parse(R"({"separation": {"turntable": {"position_deg": [0, 5], "ez_arcsec": [1, 2], "u_ez_arcsec": [0.1, 0.1],
    "status": ["near_pole", "ok"], "spot_px": [1, 2], "u_spot_px": [1, 2]}}})");
  const Certified certified = Take("turntable_autocollimator", results);
  EXPECT_EQ(Find(certified, "turntable, ez")->values, std::vector{2.0});
  EXPECT_EQ(WhyNot(certified, "turntable, ez"), "1 of 2 values: its status is near_pole");
  EXPECT_EQ(WhyNot(certified, "turntable, spot"), "its unit, px, is none that the D-SI knows");
}

TEST(Certified, NamesAStandardOnlyWhereTheReadingsAreAllThatItAsksFor) {
  json results = json::parse(R"({"iso230_2": [{"setup": 0, "missing": [], "axis": {"A": {"value_arcsec": 9.5, "u_arcsec": 0.5, "bias_arcsec": 0.25}}}]})");
  const std::string title = "positioning against the reference, mounting 0, A", bias = "scatter of the readings adds an estimated 0.25 arcsec to the value, which is not taken out";
  const Certified complete = Take("encoder_comparison", results);
  EXPECT_EQ(Find(complete, title)->norm, "ISO 230-2");
  EXPECT_EQ(Find(complete, title)->note, bias);
  results["iso230_2"][0]["missing"] = {"2 runs"};
  const Certified wanting = Take("encoder_comparison", results);
  EXPECT_EQ(Find(wanting, title)->norm, "");
  EXPECT_EQ(Find(wanting, title)->note, bias + "; not in full after ISO 230-2: 2 runs");
}

TEST(Certified, SaysWhoseErrorMotionItIsAndThatTheTableStood) {
  const json results = json::parse(R"({"iso230_7": [{"table": "target", "motion": "tilt_fixed_x", "missing": ["the axis stood"],
    "values": {"synchronous": {"value_arcsec": 9.5, "u_arcsec": 0.1, "bias_arcsec": 0.01, "u_parts": {"noise": 1.0}}}, "turns": 16}]})");
  const Certified certified = Take("rotary_4dof", results);
  const CertifiedQuantity* one = Find(certified, "error motion, target, tilt_fixed_x, synchronous");
  EXPECT_EQ(one->values, std::vector{9.5});
  EXPECT_EQ(one->norm, "");
  EXPECT_NE(one->note.find("not in full after ISO 230-7: the axis stood"), std::string::npos);
}

/// ISO 230-4 asks for radius and feed beside every value.
TEST(Certified, SaysOfWhichRadiusAndFeedACircleIs) {
  const Certified certified = Take("circular_motion", json::parse(R"({"iso230_4": [{"setup": 1, "radius_mm": 156.278, "feed_mm_min": 1000.0,
    "D_um": 0.5, "u_D_um": 0.1}]})"));
  EXPECT_TRUE(Find(certified, "circular deviations, mounting 1, radius [mm] 156.278, feed [mm/min] 1000, D"));
}

TEST(Certified, RefusesABenchOfWhoseResultsNothingIsSaid) {
  EXPECT_THROW(CertifiedPartsOf("own", "run"), InputError);
}

/// The template with every needed key filled in.
std::string Filled() {
  std::string text = LaboratoryTemplate();
  text = std::regex_replace(text, std::regex("country = \"\""), "country = \"DE\"");
  text = std::regex_replace(text, std::regex("(begin|end) = \"\""), "$1 = \"2026-02-28\"");
  return std::regex_replace(text, std::regex("\"\"(  # [^\n]*; needed)"), "\"something\"$1");
}

std::string With(const std::string& from, const std::string& to) {
  const std::string text = Filled();
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.substr(0, at) + to + text.substr(at + from.size());
}

std::string Complaint(const std::string& text) {
  return MessageOf([&] { ReadLaboratory(text, "laboratory.toml"); });
}

TEST(Laboratory, TheTemplateNamesAllThatIsMissingAtOnce) {
  EXPECT_KEPT(Complaint(LaboratoryTemplate()));
}

TEST(Laboratory, AFilledTemplateIsRead) {
  const Laboratory laboratory = ReadLaboratory(Filled(), "laboratory.toml");
  EXPECT_EQ(laboratory.identifier, "something");
  EXPECT_EQ(laboratory.customer.country, "DE");
  EXPECT_EQ(laboratory.begin, "2026-02-28");
  EXPECT_TRUE(std::isnan(laboratory.temperature_degC));
  EXPECT_FALSE(laboratory.simulated);
}

TEST(Laboratory, SaysWhereADayACountryATemperatureOrAKeyIsNone) {
  const std::pair<const char*, const char*> cases[] = {
      {"begin = \"2026-02-28\"", "begin = \"2026-02-29\""}, {"end = \"2026-02-28\"", "end = \"28.2.2026\""},
      {"end = \"2026-02-28\"", "end = \"2026-02-27\""},     {"country = \"DE\"", "country = \"Germany\""},
      {"issued = \"\"", "issued = \"2026-02-27\""},         {"# temperature_degC = 20.0", "temperature_degC = 500.0"},
      {"# temperature_degC", "temperature_degC"},           {"serial =", "seriel ="}};
  for (const auto& [from, to] : cases) {
    EXPECT_EQ(Complaint(With(from, to)).rfind("laboratory.toml:", 0), 0u) << to;
    EXPECT_KEPT(Complaint(With(from, to)));
  }
}

}  // namespace
}  // namespace twinbench::certificate
