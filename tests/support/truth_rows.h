#pragma once

#include <fstream>
#include <nlohmann/json.hpp>

#include "twin/core/table_errors.h"
#include "twin/core/units.h"

/// Truth files of the independent generator: a row a position with ex, ey, ez [arcsec], dx, dy, dz [um].
namespace twinbench::test {

inline nlohmann::json ReadTruthFile(const std::string& path) {
  std::ifstream in(path);
  return nlohmann::json::parse(in);
}

/// Errors in ascending own angle. The target's row i is its angle i steps; the reference's row j is its angle -j
/// steps.
inline TableErrors ErrorsOfRows(const nlohmann::json& rows, bool reference) {
  TableErrors errors;
  const std::size_t n = rows.size();
  for (std::size_t step = 0; step < n; ++step) {
    const nlohmann::json& row = rows.at(reference ? (n - step) % n : step);
    errors.position_rad.push_back(2.0 * units::kPi * static_cast<double>(step) / static_cast<double>(n));
    for (std::size_t c = 0; c < kComponents; ++c) {
      const double unit = IsAngle(static_cast<Component>(c)) ? units::arcsec : units::um;
      errors.value[c].push_back(row.at(c).get<double>() * unit);
    }
  }
  return errors;
}

}  // namespace twinbench::test
