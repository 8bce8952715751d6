#include <gtest/gtest.h>

#include <cmath>

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

/// The tip in the X slide's frame, actual minus ideal.
Vector3 VolumetricError_m(const MachineSettings& machine, const sim::MachineCommand& at) {
  const auto tip = [&](const sim::MachineErrors& errors) -> Vector3 {
    return sim::X_MS(at, errors).inverse() * sim::X_MT(at, errors, machine.pivot_m).translation();
  };
  return tip(sim::ErrorsAt(machine, at)) - tip({});
}

TEST(Freeform, MovesTheTipByEachErrorAsTheOracleDoes) {
  const CsvTable table = ReadCsv(OraclePath("tip.csv"));
  ASSERT_EQ(table.rows.size(), 127u);
  for (const CsvTable::Row& row : table.rows) {
    MachineSettings machine;
    SetError(row.fields[0], CsvNumber(table, row, 1, 1.0), machine);
    const Vector3 off = VolumetricError_m(machine, CommandOf(table, row, 2)) - Tip_m(table, row, 7);
    EXPECT_LT(off.cwiseAbs().maxCoeff(), kNanometre) << row.fields[0];
  }
}

// Heights of the artefact that no formula gives.

TEST(FreeformOptics, HeightsComeBackFromTheirFile) {
  const auto tilted = [](double x_m, double y_m) { return 20.0 * x_m - 50.0 * y_m + 1.0; };
  const optics::HeightMap map = optics::ReadHeightMap(WriteHeights("form.exr", tilted));
  for (const auto& [x_m, y_m] : {std::pair{0.0, 0.0}, std::pair{0.0123, -0.0456}, std::pair{-0.1, 0.1}}) {
    const optics::HeightAt at = optics::Interpolate(map, x_m, y_m);
    EXPECT_NEAR(at.height_m / units::um, tilted(x_m, y_m), 1e-5);  // floats in the file
    EXPECT_NEAR(at.slope.x(), 20.0 * units::um, 1e-9);
    EXPECT_NEAR(at.slope.y(), -50.0 * units::um, 1e-9);
  }
}

/// What the scenario with a map shows, without noise and errors, on the course of its procedure.
std::vector<Reading> ShownWith(const std::string& file) {
  const std::string artefact = "[artefact]\nmounting_um = 0.0\nform_error = \"" + file + "\"\n";
  return RunOf(FreeformScenario("noise_free = true\n" + artefact + "[freeform_procedure]\nposes = 30\n"), {});
}

TEST(FreeformOptics, AnArrayThatIsHigherAllOverIsAMountingThatIsHigher) {
  const std::vector<Reading> high = ShownWith(WriteHeights("high.exr", [](double, double) { return 5.0; }));
  const Scenario scenario = FreeformScenario("noise_free = true\n[freeform_procedure]\nposes = 30\n");
  sim::DrawnBench lifted;
  lifted.mountings.assign(4, {0.0, 0.0, 5.0 * units::um, 0.0, 0.0, 0.0});
  const std::vector<Reading> same = RunOf(scenario, lifted);
  for (std::size_t k = 0; k < high.size(); ++k) {
    EXPECT_NEAR(kCcd_px(high[k]), kCcd_px(same[k]), 1e-5);  // floats in the file: 5 um to 0.5 pm
    EXPECT_NEAR(kQpdX_V(high[k]), kQpdX_V(same[k]), 1e-6);
  }
}

TEST(FreeformOptics, AFormErrorThatTheScenarioHasIsNoSurprise) {
  const std::string path =
      WriteHeights("wave.exr", [](double x_m, double y_m) { return std::sin(60.0 * x_m) * std::cos(40.0 * y_m); });
  const std::string more = "[artefact]\nform_error = \"" + path + "\"\n[freeform_procedure]\nposes = 45\n";
  const Scenario scenario = FreeformScenario(more);
  EXPECT_EQ(DiagnosisOf(RunOf(scenario), scenario).verdict, diagnose::Verdict::kNone);
}

TEST(FreeformOptics, AMapThatIsNotThereIsAnError) {
  EXPECT_THROW(ShownWith("/nowhere/form.exr"), InputError);
}

}  // namespace
}  // namespace twinbench::freeform_test
