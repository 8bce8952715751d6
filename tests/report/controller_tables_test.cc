#include "twin/report/controller_tables.h"

#include <gmock/gmock.h>

#include "tests/core/input_error.h"
#include "tests/support/kept_text.h"
#include "twin/core/units.h"
#include "twin/report/compensation_text.h"

namespace twinbench::report {
namespace {

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

}  // namespace
}  // namespace twinbench::report
