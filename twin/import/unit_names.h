#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// The names that people give to units in files of their own.
namespace twinbench::imports {

enum class Dimension { kAngle, kLength, kTime, kSpeed, kTurning, kVoltage, kTemperature, kPure };

struct NamedUnit {
  std::string_view name;  // "mm"
  Dimension dimension = Dimension::kPure;
  double to_SI = 1.0;
};

/// Also knows the names that are written otherwise: "°", "degrees", "µm", "revs", "\"", and an angle or a length
/// over a time: "mm/min", "deg/s", "mm_min".
std::optional<NamedUnit> UnitNamed(std::string_view text);

/// The unit with which a key or a column ends: "deg" of "reference_deg", "mm_min" of "feed_mm_min"; nothing if it
/// ends in none.
std::optional<NamedUnit> UnitAtEnd(std::string_view name);

/// Every plain name of a unit of that dimension, for keys: "deg", "rad", "arcsec", ...
std::vector<NamedUnit> UnitsOf(Dimension dimension);

/// "; the nearest is deg" of "dge": what a refusal adds where a unit of these dimensions is misspelt by a letter or
/// two; else nothing.
std::string NearestUnit(std::string_view misspelt, const std::vector<Dimension>& dimensions);

/// A header's field taken apart: "Angle [deg]", "angle (deg)", "angle / deg", "angle, deg", "angle_deg",
/// "angleDeg", "angle".
struct NameAndUnit {
  std::string name, unit;
};
NameAndUnit SplitHeader(std::string_view field);

/// "[deg]", "(mm)" or "mm": the unit, or nothing if the text is none.
std::optional<std::string> BareUnit(std::string_view field);

}  // namespace twinbench::imports
