#include "tests/foreign/grating_stand.h"

#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <sstream>

#include "tests/support/twin_run.h"

namespace twinbench::foreign {
namespace {

using Row = std::map<std::string, std::string>;

std::vector<Row> RowsOf(const std::string& path) {
  std::ifstream file(path);
  std::vector<std::string> names;
  std::vector<Row> rows;
  for (std::string line; std::getline(file, line);) {
    std::erase(line, '\r');
    std::stringstream fields(line);
    std::vector<std::string> values;
    for (std::string value; std::getline(fields, value, ',');) values.push_back(value);
    if (names.empty()) {
      names = values;
      continue;
    }
    Row& row = rows.emplace_back();
    for (std::size_t k = 0; k < names.size(); ++k) row[names[k]] = values.at(k);
  }
  return rows;
}

TableError ErrorOf(const Row& row, const std::string& table) {
  const auto of = [&](const char* name) { return std::stod(row.at(table + name)); };
  return {of("_ex_arcsec") * units::arcsec, of("_ey_arcsec") * units::arcsec, of("_ez_arcsec") * units::arcsec,
          of("_dx_um") * units::um,         of("_dy_um") * units::um,         of("_dz_um") * units::um};
}

/// The poses come from an implementation that shares nothing with this one; their spots are printed to 1e-9 um.
TEST(GratingStand, ShinesWhereTheIndependentPosesSay) {
  const std::vector<Row> rows = RowsOf(test::DataPath("oracle/poses.csv"));
  ASSERT_GT(rows.size(), 100U);
  for (const Row& row : rows) {
    const auto angle = [&](const char* name) { return std::stod(row.at(name)) * units::deg; };
    const Stacking stacking{angle("target_deg"), angle("reference_deg"), angle("shift_deg"),
                            row.at("mode") == "reseat", ErrorOf(row, "target"), ErrorOf(row, "reference"), {}};
    const Spots spots = ShineOn(GratingOn(stacking), {});
    for (const auto& [at_m, column] : {std::pair{spots.u_a_m, "psd_a_u_um"}, {spots.v_a_m, "psd_a_v_um"},
                                       {spots.u_b_m, "psd_b_u_um"}, {spots.v_b_m, "psd_b_v_um"}})
      EXPECT_NEAR(at_m / units::um, std::stod(row.at(column)), 1e-5) << column;
  }
}

}  // namespace
}  // namespace twinbench::foreign
