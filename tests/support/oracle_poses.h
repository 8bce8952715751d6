#pragma once

#include <array>
#include <map>

#include "twin/core/csv.h"

namespace twinbench::test {

using CsvRow = std::map<std::string, std::string>;  // by column

/// Rows of a table of the independent oracle.
inline std::vector<CsvRow> ReadCsvRows(const std::string& path) {
  const CsvTable table = ReadCsv(path);
  std::vector<CsvRow> rows;
  for (const CsvTable::Row& row : table.rows) {
    rows.emplace_back();
    for (std::size_t i = 0; i < row.fields.size(); ++i) rows.back()[table.columns[i]] = row.fields[i];
  }
  return rows;
}

inline double Number(const CsvRow& row, const std::string& column) { return std::stod(row.at(column)); }

/// ex, ey, ez [rad] and dx, dy, dz [m] of a table, in the frame of its base.
using OracleError = std::array<double, 6>;

/// A pose of the rotary bench, and where an implementation that shares nothing with this one sees its spots.
struct OraclePose {
  bool is_reclamped;  // else reseated
  double target_rad, reference_rad, shift_rad;
  OracleError target, reference;
  std::array<double, 4> spots_m;  // u, v on detector A, u, v on B; printed to 1e-15 m
};

inline std::vector<OraclePose> OraclePoses() {
  constexpr double kDegree = std::numbers::pi / 180.0, kArcsec = kDegree / 3600.0, kUm = 1e-6;
  std::vector<OraclePose> poses;
  for (const CsvRow& row : ReadCsvRows(TWINBENCH_TEST_DATA "/oracle/poses.csv")) {
    const auto of = [&](const std::string& column, double unit) { return Number(row, column) * unit; };
    const auto error = [&](const std::string& table) {
      return OracleError{of(table + "_ex_arcsec", kArcsec), of(table + "_ey_arcsec", kArcsec),
                         of(table + "_ez_arcsec", kArcsec), of(table + "_dx_um", kUm),
                         of(table + "_dy_um", kUm),         of(table + "_dz_um", kUm)};
    };
    poses.push_back({row.at("mode") == "reclamp", of("target_deg", kDegree), of("reference_deg", kDegree),
                     of("shift_deg", kDegree), error("target"), error("reference"),
                     {of("psd_a_u_um", kUm), of("psd_a_v_um", kUm), of("psd_b_u_um", kUm), of("psd_b_v_um", kUm)}});
  }
  return poses;
}

}  // namespace twinbench::test
