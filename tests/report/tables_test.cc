#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "tests/core/input_error.h"
#include "tests/support/kept_text.h"
#include "twin/core/units.h"
#include "twin/report/compensation_text.h"
#include "twin/report/controller_tables.h"
#include "twin/report/curve_score.h"
#include "twin/report/text_table.h"

namespace twinbench::report {
namespace {

TEST(TextTable, AlignsColumnsAndCellsOfSeveralLines) {
  EXPECT_KEPT(TextTable({{"cause"}, {"share", true}}, {{"play\n  lost motion", "97 %"}, {"drift", "3 %"}}, 80));
}

TEST(TextTable, BreaksTheWidestColumnAtWordsAndKeepsItsIndent) {
  EXPECT_KEPT(TextTable({{"a"}, {"b"}}, {{"name\n  one two three four five six", "1"}}, 20));
}

TEST(TextTable, KeepsAWholeColumnAsLongAsOthersCanGiveWay) {
  const std::string title = "some thirty letters of a title of";
  EXPECT_KEPT(TextTable({{"a"}, {"b", false, true}}, {{title, "1.0000000 ± 0.0000001 µm"}}, 56));
}

TEST(TextTable, LeavesOutColumnsWithoutCells) {
  EXPECT_EQ(TextTable({{"a"}, {"b"}}, {{"1"}}, 80), "a\n-\n1\n");
  EXPECT_EQ(TextTable({{"a"}}, {}, 80), "");
}

TEST(TextTable, CountsCharactersAndNotBytes) {
  EXPECT_EQ(WidthOf("10 µm ●"), 7u);
  EXPECT_KEPT(TextTable({{"a"}, {"b"}}, {{"µµµ", "1"}, {"mmm", "2"}}, 80));
}

TEST(Paragraph, HangsBehindItsHead) {
  EXPECT_EQ(Paragraph("! ", "one two three", 2, 9), "! one two\n  three\n");
}

using testing::HasSubstr, units::arcsec, units::deg;

CompensationTable Quarters() {
  return {{0.0, 90.0 * deg, 180.0 * deg, 270.0 * deg}, {3.6 * arcsec, -7.2 * arcsec, 0.0, 1.8 * arcsec}};
}

TEST(ControllerTable, GivesLinuxCncTheActualPositions) {
  // Trim = nominal - actual is what is added: 3.6 arcsec = 0.001 deg too little at 0 deg.
  EXPECT_EQ(ControllerTable("linuxcnc", Quarters(), "C", {"a comment would end the reading"}),
            "0.000000000 -0.001000000 -0.001000000\n"
            "90.000000000 90.002000000 90.002000000\n"
            "180.000000000 180.000000000 180.000000000\n"
            "270.000000000 269.999500000 269.999500000\n"
            "360.000000000 359.999000000 359.999000000\n");
}

TEST(ControllerTable, GivesTwinCatAdditiveValuesOverAModuloTurn) {
  EXPECT_KEPT(ControllerTable("twincat", Quarters(), "C", {"of a turntable"}));
}

TEST(ControllerTable, GivesHeidenhainItsColumns) {
  EXPECT_KEPT(ControllerTable("heidenhain", Quarters(), "B", {}));
}

TEST(ControllerTable, StartsAtZeroWhereTheTableDoesNot) {
  const CompensationTable table{{90.0 * deg, 270.0 * deg}, {3.6 * arcsec, 7.2 * arcsec}};
  EXPECT_THAT(ControllerTable("linuxcnc", table, "C", {}), HasSubstr("0.000000000 -0.001500000 -0.001500000\n9"));
}

TEST(ControllerTable, RefusesMoreEntriesThanTheControllerTakes) {
  CompensationTable table;
  for (int i = 0; i < 256; ++i) {
    table.position_rad.push_back(i * deg);
    table.correction_rad.push_back(0.0);
  }
  for (const char* form : {"linuxcnc", "heidenhain"})
    EXPECT_KEPT(MessageOf([&] { ControllerTable(form, table, "C", {}); }));
  EXPECT_NO_THROW(ControllerTable("twincat", table, "C", {}));
}

TEST(ControllerTable, NamesTheFormsThereAre) {
  EXPECT_KEPT(MessageOf([] { ControllerFormNamed("fanuc"); }));
}

TEST(OrderRanges, JoinsNeighbours) {
  EXPECT_EQ(OrderRanges({1, 2, 3, 18, 90, 91}), "orders 1-3, 18, 90-91");
  EXPECT_EQ(OrderRanges({7}), "order 7");
}

TEST(CurveScore, TellsTheLargestErrorOfEitherSignAndLeavesOutWhatIsNotKnown) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  const CurveScore curve{"turntable", "ez_arcsec", "position_deg", {0.0, 90.0, 180.0, 270.0}, {1.0, -2.5, 0.5, kNaN},
                         {0.5, 0.5, 0.5, 0.5}, {0.0, 0.5, 0.0, 0.0}};
  const nlohmann::json score = ToJson({curve})["turntable"]["ez"];
  EXPECT_DOUBLE_EQ(score["worst_error_arcsec"].get<double>(), 3.0);
  EXPECT_NEAR(score["rms_error_arcsec"].get<double>(), std::sqrt((1.0 + 9.0 + 0.25) / 3.0), 1e-12);
}

}  // namespace
}  // namespace twinbench::report
