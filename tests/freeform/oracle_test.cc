#include <gtest/gtest.h>

#include "tests/freeform/freeform_run.h"

// Expected values are those of an implementation that was written independently from the bench's stated formulas.
namespace twinbench::freeform_test {
namespace {

sim::MachineCommand CommandOf(const CsvTable& table, const CsvTable::Row& row, std::size_t first) {
  sim::MachineCommand at{};
  for (std::size_t axis = 0; axis < kMachineAxes; ++axis)
    at[axis] = CsvNumber(table, row, first + axis, axis < 3 ? units::mm : units::deg);
  return at;
}

Vector3 Tip_m(const CsvTable& table, const CsvTable::Row& row, std::size_t first) {
  return {CsvNumber(table, row, first, units::um), CsvNumber(table, row, first + 1, units::um),
          CsvNumber(table, row, first + 2, units::um)};
}

/// "x.tx0" or "syx".
void SetError(const std::string& name, double value, MachineSettings& machine) {
  for (std::size_t k = 0; k < kSquarenesses; ++k) {
    if (name == kSquarenessNames[k]) machine.squareness_rad[k] = value * units::arcsec;
  }
  for (std::size_t axis = 0; axis < kMachineAxes; ++axis) {
    for (std::size_t k = 0; k < kBodyErrors; ++k) {
      for (std::size_t term = 0; term < kCubicTerms; ++term) {
        if (name == std::string(kAxisNames[axis]) + "." + kBodyErrorNames[k] + std::to_string(term))
          machine.errors[axis][k][term] = value * UnitOfError(k);
      }
    }
  }
}

constexpr double kNanometre = 1e-9;  // to which the bench is to agree

TEST(Freeform, MovesTheTipByEachErrorAsTheOracleDoes) {
  const CsvTable table = ReadCsv(OraclePath("tip.csv"));
  ASSERT_EQ(table.rows.size(), 127u);
  for (const CsvTable::Row& row : table.rows) {
    MachineSettings machine;
    SetError(row.fields[0], CsvNumber(table, row, 1, 1.0), machine);
    const Vector3 off = sim::VolumetricError_m(machine, CommandOf(table, row, 2)) - Tip_m(table, row, 7);
    EXPECT_LT(off.cwiseAbs().maxCoeff(), kNanometre) << row.fields[0];
  }
}

TEST(Freeform, MovesTheTipByAllErrorsTogetherAsTheOracleDoes) {
  const CsvTable table = ReadCsv(OraclePath("unseen.csv"));
  const MachineSettings machine = OracleBench().machine;
  ASSERT_GT(table.rows.size(), 100u);
  for (const CsvTable::Row& row : table.rows) {
    const Vector3 off = sim::VolumetricError_m(machine, CommandOf(table, row, 0)) - Tip_m(table, row, 5);
    EXPECT_LT(off.cwiseAbs().maxCoeff(), kNanometre);
  }
}

TEST(Freeform, MeetsTheSurfaceAndIsReflectedAsTheOracleIs) {
  const CsvTable table = ReadCsv(OraclePath("spot.csv"));
  const std::vector<Reading> readings = OracleRun();
  const sim::DrawnBench bench = OracleBench();
  const FreeformSettings settings;
  ASSERT_EQ(table.rows.size(), 96u);
  for (const CsvTable::Row& row : table.rows) {
    const Reading& r = readings[static_cast<std::size_t>(CsvNumber(table, row, 0, 1.0))];
    const sim::ProbeSpot spot = sim::Look(settings.artefact, CellAt(r), ToolOverArtefact(r, bench, settings));
    const Vector3 reflected(CsvNumber(table, row, 2, 1.0), CsvNumber(table, row, 3, 1.0), CsvNumber(table, row, 4, 1.0));
    EXPECT_LT((spot.reflected_T - reflected).norm(), 1e-12);  // the oracle's last digit
    EXPECT_NEAR(spot.distance_m, CsvNumber(table, row, 5, units::um), kNanometre);
    EXPECT_NEAR(spot.hit_F.x(), CsvNumber(table, row, 6, units::mm), kNanometre);
    EXPECT_NEAR(spot.hit_F.y(), CsvNumber(table, row, 7, units::mm), kNanometre);
  }
}

}  // namespace
}  // namespace twinbench::freeform_test
