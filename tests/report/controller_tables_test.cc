#include "twin/report/controller_tables.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <sstream>

#include "tests/core/input_error.h"
#include "twin/core/units.h"
#include "twin/report/compensation_text.h"

namespace twinbench::report {
namespace {

using testing::HasSubstr;
using units::arcsec, units::deg;

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
  const std::string text = ControllerTable("twincat", Quarters(), "C", {"of a turntable"});
  EXPECT_THAT(text, HasSubstr("// of a turntable\n"));
  EXPECT_THAT(text, HasSubstr("ARRAY[1..5] OF ST_PositionCompensationTableElement"));
  EXPECT_THAT(text, HasSubstr("(Position := 90.000000000, Compensation := -0.002000000),\n"));
  EXPECT_THAT(text, HasSubstr("(Position := 360.000000000, Compensation := 0.001000000)];\n"));
  EXPECT_THAT(text, HasSubstr("NoOfTableElements := 5"));
  EXPECT_THAT(text, HasSubstr("Modulo := TRUE"));
}

TEST(ControllerTable, GivesHeidenhainItsColumns) {
  std::istringstream lines(ControllerTable("heidenhain", Quarters(), "B", {}));
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line, "BEGIN B.COM");
  std::getline(lines, line);
  std::istringstream header(line);
  std::string nr, axispos, backlash, axis;
  header >> nr >> axispos >> backlash >> axis;
  EXPECT_EQ(nr + axispos + backlash + axis, "NRAXISPOSBACKLASHB");
  std::getline(lines, line);
  std::getline(lines, line);
  std::istringstream second(line);
  int number = 0;
  double position_deg = 0.0, backlash_deg = 1.0, correction_deg = 0.0;
  second >> number >> position_deg >> backlash_deg >> correction_deg;
  EXPECT_EQ(number, 1);
  EXPECT_EQ(position_deg, 90.0);
  EXPECT_EQ(backlash_deg, 0.0);
  EXPECT_EQ(correction_deg, -0.002);
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
  EXPECT_THAT(MessageOf([&] { ControllerTable("linuxcnc", table, "C", {}); }), HasSubstr("--points 255"));
  EXPECT_THAT(MessageOf([&] { ControllerTable("heidenhain", table, "C", {}); }), HasSubstr("257 entries"));
  EXPECT_NO_THROW(ControllerTable("twincat", table, "C", {}));
}

TEST(ControllerTable, NamesTheFormsThereAre) {
  EXPECT_THAT(MessageOf([] { ControllerFormNamed("fanuc"); }), HasSubstr("plain, linuxcnc, twincat, heidenhain"));
}

TEST(OrderRanges, JoinsNeighbours) {
  EXPECT_EQ(OrderRanges({1, 2, 3, 18, 90, 91}), "orders 1-3, 18, 90-91");
  EXPECT_EQ(OrderRanges({7}), "order 7");
}

}  // namespace
}  // namespace twinbench::report
