#pragma once

#include <array>
#include <string>
#include <vector>

namespace twinbench {

/// The six error motions of a rotary table in the order of every array and file here.
/// ex, ey: wobble (EAC, EBC of ISO 230-7); ez: index (ECC); dx, dy: radial (EXC, EYC); dz: axial (EZC).
enum class Component { kEx, kEy, kEz, kDx, kDy, kDz };
inline constexpr int kComponents = 6;
inline constexpr std::array<const char*, kComponents> kComponentNames = {"ex", "ey", "ez", "dx", "dy", "dz"};

/// Whether it is an angle [rad]; the others are lengths [m].
inline bool IsAngle(Component component) {
  return component <= Component::kEz;
}

/// Error motions of one table at given angles of that table, [rad] for ex..ez and [m] for dx..dz.
/// The target's are in the laboratory frame; the reference's in its own rotor frame
/// (docs/theory.md 3). All columns have one entry a position.
struct TableErrors {
  std::vector<double> position_rad;
  std::array<std::vector<double>, kComponents> value;

  const std::vector<double>& operator[](Component c) const { return value[static_cast<std::size_t>(c)]; }
  std::vector<double>& operator[](Component c) { return value[static_cast<std::size_t>(c)]; }
};

/// How the column of a component is headed in files, and its unit: "ex_arcsec", "dx_um".
struct ErrorColumn {
  std::string name;
  double to_SI;
};
ErrorColumn ColumnOf(Component component);
ErrorColumn PositionColumn();  // "position_deg"

/// Reads an errors file: a header, `position_deg` and any of ex_arcsec, ey_arcsec, ez_arcsec, dx_um, dy_um,
/// dz_um; lines beginning with # are comments; absent columns are zero.
/// @throws InputError with file:line for a missing position column, an unknown column, a field that is no number or
///         a file without rows.
TableErrors ReadTableErrors(const std::string& path);

}  // namespace twinbench
