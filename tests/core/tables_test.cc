#include "tests/core/input_error.h"
#include "tests/core/refusals.h"
#include "twin/core/compensation_table.h"
#include "twin/core/csv.h"
#include "twin/core/sampled_curve.h"
#include "twin/core/table_errors.h"
#include "twin/core/units.h"

namespace twinbench {
namespace {

CsvTable ParseTable(const std::string& text) {
  std::istringstream in(text);
  return ParseCsv(in, "t.csv");
}

std::string TableError(const std::string& text) { return MessageOf([&] { ParseTable(text); }); }

TEST(Csv, SkipsCommentsCountsTheirLinesAndTakesFilesOfOtherSystemsAndEmptyFields) {
  const CsvTable table = ParseTable("# made by hand\na,b\n\n# a comment\n1,2\n");
  ASSERT_EQ(table.rows.size(), 1u);
  EXPECT_EQ(table.WhereHeader(), "t.csv:2");
  EXPECT_EQ(table.Where(table.rows[0]), "t.csv:5");
  const CsvTable foreign = ParseTable("\xEF\xBB\xBF" "a,b\r\n 1 ,2\r\n");
  EXPECT_EQ(foreign.columns, (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(foreign.rows[0].fields, (std::vector<std::string>{"1", "2"}));
  EXPECT_EQ(ParseTable("a,b,c\n,,\n").rows[0].fields, (std::vector<std::string>{"", "", ""})) << "also the last";
}

TEST(Csv, ReadsWhatItQuotes) {
  for (const std::string text : {"plain", "two, parts", "a \"word\"", " blanks ", "#no comment", ""}) {
    const CsvTable table = ParseTable("a,b\n" + QuoteCsv(text) + ",1\n");
    EXPECT_EQ(table.rows[0].fields[0], text);
    EXPECT_EQ(table.rows[0].fields[1], "1");
  }
}

TEST(Csv, NamesLineAndFaultOfABadFile) {
  ExpectRefused("t.csv", TableError,
                {{1, ""}, {1, "a,,c\n"}, {1, "a,b,a\n"}, {3, "a,b\n1,2\n1,2,3\n"}, {2, "a\n\"open\n"}});
  const CsvTable table = ParseTable("a,b\n1,x\n");
  EXPECT_KEPT(MessageOf([&] { CsvNumber(table, table.rows[0], 1, 1.0); }));
  EXPECT_KEPT(MessageOf([] { ReadCsv("no_such.csv"); }));
  EXPECT_KEPT(MessageOf([] { ReadCsv("/"); }));
  EXPECT_KEPT(MessageOf([] { ReadCsv("/dev/null"); }));
  for (const char* header : {"mesured_deg", "measured_arcsec", "nothing_like_it"}) {
    const CsvTable other = ParseTable(std::string(header) + "\n1\n");
    EXPECT_KEPT(MessageOf([&] { NeededColumn(other, "measured_deg", "two angles"); }));
  }
}

TEST(TableErrors, HaveUnitsInTheirColumnsAndZerosForAbsentOnes) {
  const TemporaryFolder folder;
  const TableErrors errors =
      ReadTableErrors(folder.Write("t.csv", "# target\ndx_um,position_deg,ez_arcsec\n1.5,0,-2\n2.5,90,3\n"));
  EXPECT_EQ(errors.position_rad, (std::vector<double>{0.0, 90.0 * units::deg}));
  EXPECT_EQ(errors[Component::kDx], (std::vector<double>{1.5 * units::um, 2.5 * units::um}));
  EXPECT_EQ(errors[Component::kEz], (std::vector<double>{-2.0 * units::arcsec, 3.0 * units::arcsec}));
  EXPECT_EQ(errors[Component::kEy], (std::vector<double>{0.0, 0.0}));
}

TEST(TableErrors, NameLineAndFaultOfABadFile) {
  const TemporaryFolder folder;
  ExpectRefused(folder.File("t.csv"),
                [&](const auto& text) { return MessageOf([&] { ReadTableErrors(folder.Write("t.csv", text)); }); },
                {{1, "ex_arcsec\n1\n"}, {2, "#\nposition_deg,ex_urad\n1,2\n"},
                 {3, "position_deg,dx_um\n1,2\n2,abc\n"}, {2, "position_deg,dx_um\n1,nan\n"},
                 {2, "position_deg,dx_um\n1,\n"}, {1, "position_deg,dx_um\n"}});
}

TEST(SampledCurve, IsStraightBetweenPlacesAndLevelBeyondTheEndsAndReadFromItsColumnsInSIUnits) {
  const TemporaryFolder folder;
  const std::string path = folder.Write("inl.csv", "error_mV,voltage_V\n2,-1\n4,1\n");
  EXPECT_DOUBLE_EQ(ReadSampledCurve(path, {"voltage_V"}, {"error_mV", 1e-3}).At(0.0), 3e-3);
  for (const double place : {-1.0, 3.0, 4.0}) EXPECT_EQ(SampledCurve({3.0}, {7.0}).At(place), 7.0) << "one place";
  const SampledCurve curve({1.0, 2.0, 4.0}, {10.0, 20.0, 0.0});
  const std::vector<std::pair<double, double>> expected = {{-5.0, 10.0}, {1.0, 10.0}, {1.5, 15.0}, {2.0, 20.0},
                                                           {3.0, 10.0},  {4.0, 0.0},  {9.0, 0.0}};
  for (const auto& [place, value] : expected) EXPECT_DOUBLE_EQ(curve.At(place), value) << place;
}

TEST(SampledCurve, AFileThatCannotBeUsedIsNamedWithItsLine) {
  const TemporaryFolder folder;
  const auto message = [&](const std::string& text) {
    return MessageOf([&] { ReadSampledCurve(folder.Write("room.csv", text), {"time_s"}, {"temperature_degC"}); });
  };
  ExpectRefused(folder.File("room.csv"), message,
                {{1, "time_s\n1\n"}, {4, "time_s,temperature_degC\n0,20\n5,21\n5,22\n"}});
  EXPECT_KEPT(message("time_s,temperature_degC\n"));
}

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
