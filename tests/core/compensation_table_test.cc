#include "twin/core/compensation_table.h"

#include <gtest/gtest.h>

#include "tests/core/input_error.h"
#include "tests/core/refusals.h"
#include "twin/core/units.h"

namespace twinbench {
namespace {

using units::arcsec, units::deg;

CompensationTable ThreeEntries() {
  return {{10.0 * deg, 100.0 * deg, 340.0 * deg}, {1.0 * arcsec, -2.0 * arcsec, 4.0 * arcsec}};
}

constexpr double kExact_rad = 1e-12 * arcsec;  // rounding of degrees

TEST(CompensationTable, IsStraightBetweenEntriesClosesTheTurnIsTheSameInEachAndAddedToTheAngle) {
  const CompensationTable table = ThreeEntries();
  EXPECT_NEAR(table.At(10.0 * deg), 1.0 * arcsec, kExact_rad);
  EXPECT_NEAR(table.At(55.0 * deg), -0.5 * arcsec, kExact_rad);
  EXPECT_NEAR(table.At(355.0 * deg), 2.5 * arcsec, kExact_rad);  // half-way from 340 to 370 deg
  EXPECT_NEAR(table.At(0.0), 2.0 * arcsec, kExact_rad);
  for (const double turn_deg : {-720.0, -360.0, 360.0, 3600.0})
    EXPECT_NEAR(table.At((turn_deg + 55.0) * deg), table.At(55.0 * deg), 1e-9 * arcsec);
  EXPECT_NEAR(CommandedAngle_rad(table, 370.0 * deg), 370.0 * deg + 1.0 * arcsec, 1e-9 * arcsec);
  EXPECT_EQ(CommandedAngle_rad(std::nullopt, 1.25), 1.25);
}

TEST(CompensationTable, ComesBackFromItsFileToTheSameBits) {
  const TemporaryFolder folder;
  CompensationTable table = ThreeEntries();
  table.correction_rad[1] = 1.0 / 3.0 * arcsec;
  const std::string path = folder.Write("table.csv", CompensationCsv(table, {"of a turntable", "orders 1, 2"}));
  const CompensationTable back = ReadCompensationTable(path);
  EXPECT_EQ(back.position_rad, table.position_rad);
  EXPECT_EQ(back.correction_rad, table.correction_rad);
}

TEST(CompensationTable, RefusesWhatIsNoTurn) {
  const TemporaryFolder folder;
  ExpectRefused(
      folder.File("t.csv"),
      [&](const auto& text) { return MessageOf([&] { ReadCompensationTable(folder.Write("t.csv", text)); }); },
      {{1, "position_deg,ez_arcsec\n0,1\n"}, {1, "position_deg,correction_arcsec\n0,1\n0,2\n"},
       {1, "position_deg,correction_arcsec\n0,1\n360,2\n"}, {1, "position_deg,correction_arcsec\n"}});
}

}  // namespace
}  // namespace twinbench
