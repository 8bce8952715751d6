#pragma once

#include <optional>
#include <string>
#include <vector>

namespace twinbench {

/// What is added to the angles that a rotary table is commanded to, so that it arrives where it should: the
/// compensation of its index error. One turn; between the entries straight, as controllers interpolate.
struct CompensationTable {
  std::vector<double> position_rad;    // of the table, ascending in [0, 2 pi)
  std::vector<double> correction_rad;  // one a position

  /// At any angle, also an unwrapped one.
  double At(double angle_rad) const;
  /// Of the straight piece there: change of the correction by the angle.
  double SlopeAt(double angle_rad) const;

  bool operator==(const CompensationTable&) const = default;
};

/// Where a table is sent so that it arrives at an angle; the angle itself without a compensation.
double CommandedAngle_rad(const std::optional<CompensationTable>& compensation, double angle_rad);

/// How the columns are headed in files and in a scenario: "position_deg", "correction_arcsec".
inline constexpr const char* kCompensationPosition = "position_deg";
inline constexpr const char* kCompensationCorrection = "correction_arcsec";

/// @throws InputError at `where` if there is no entry, or the positions do not ascend in [0, 360) degrees.
void RequireOneTurn(const CompensationTable& table, const std::string& where);

/// Reads a file with the columns position_deg and correction_arcsec; lines that begin with # are comments, other
/// columns are ignored.
/// @throws InputError with file:line for a missing column, a field that is no number or entries that are no turn.
CompensationTable ReadCompensationTable(const std::string& path);

/// The same format, with as many digits as the numbers have.
/// @param comments  Lines without their #.
std::string CompensationCsv(const CompensationTable& table, const std::vector<std::string>& comments);

}  // namespace twinbench
