#include "twin/import/unit_names.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

#include "twin/core/nearest_key.h"
#include "twin/core/units.h"
#include "twin/import/common.h"
#include "twin/import/text.h"

namespace twinbench::imports {
namespace {

struct Spelling {
  std::string_view spelling;  // in small letters
  std::string_view name;
};

constexpr std::array kUnits = std::to_array<NamedUnit>({
    {"deg", Dimension::kAngle, units::deg},
    {"rad", Dimension::kAngle, 1.0},
    {"mrad", Dimension::kAngle, units::mrad},
    {"urad", Dimension::kAngle, units::urad},
    {"arcsec", Dimension::kAngle, units::arcsec},
    {"arcmin", Dimension::kAngle, units::deg / 60.0},
    {"mdeg", Dimension::kAngle, 1e-3 * units::deg},
    {"gon", Dimension::kAngle, units::turn / 400.0},
    {"turn", Dimension::kAngle, units::turn},
    {"m", Dimension::kLength, 1.0},
    {"dm", Dimension::kLength, 0.1},
    {"cm", Dimension::kLength, 0.01},
    {"mm", Dimension::kLength, units::mm},
    {"um", Dimension::kLength, units::um},
    {"nm", Dimension::kLength, units::nm},
    {"inch", Dimension::kLength, 0.0254},
    {"mil", Dimension::kLength, 25.4e-6},
    {"uinch", Dimension::kLength, 25.4e-9},
    {"s", Dimension::kTime, 1.0},
    {"ms", Dimension::kTime, 1e-3},
    {"us", Dimension::kTime, 1e-6},
    {"ns", Dimension::kTime, 1e-9},
    {"min", Dimension::kTime, 60.0},
    {"h", Dimension::kTime, 3600.0},
    {"day", Dimension::kTime, 86400.0},
    {"V", Dimension::kVoltage, 1.0},
    {"mV", Dimension::kVoltage, 1e-3},
    {"degC", Dimension::kTemperature, 1.0},
});

constexpr std::array kSpellings = std::to_array<Spelling>({
    {"°", "deg"},           {"degree", "deg"},   {"degrees", "deg"},     {"grad", "deg"},
    {"º", "deg"},           {"radian", "rad"},   {"radians", "rad"},     {"µrad", "urad"},
    {"μrad", "urad"},       {"as", "arcsec"},    {"a-s", "arcsec"},      {"asec", "arcsec"},
    {"arc-sec", "arcsec"},  {"\"", "arcsec"},    {"″", "arcsec"},        {"''", "arcsec"},        {"arcseconds", "arcsec"}, {"arc seconds", "arcsec"}, {"angular seconds", "arcsec"}, {"seconds of arc", "arcsec"}, {"arc minutes", "arcmin"},
    {"arc-min", "arcmin"},  {"'", "arcmin"},     {"′", "arcmin"},        {"turns", "turn"},
    {"rev", "turn"},        {"revs", "turn"},    {"revolution", "turn"}, {"revolutions", "turn"},
    {"u", "turn"},          {"meter", "m"},      {"metre", "m"},         {"millimeter", "mm"},
    {"millimetre", "mm"},   {"µm", "um"},        {"μm", "um"},           {"micron", "um"},
    {"microns", "um"},      {"in", "inch"},      {"sec", "s"},           {"second", "s"},
    {"seconds", "s"},       {"msec", "ms"},      {"millis", "ms"},       {"milliseconds", "ms"},
    {"µs", "us"},           {"μs", "us"},        {"usec", "us"},         {"micros", "us"},
    {"microseconds", "us"}, {"millisec", "ms"}, {"millisecs", "ms"}, {"millisecond", "ms"}, {"microsec", "us"}, {"microsecond", "us"}, {"nanosec", "ns"},
    {"nanoseconds", "ns"},  {"nanosecond", "ns"}, {"secs", "s"}, {"mins", "min"}, {"hour", "h"}, {"hr", "h"}, {"hrs", "h"}, {"nsec", "ns"},      {"minutes", "min"},     {"hours", "h"},    {"days", "day"},
    {"volt", "V"},          {"volts", "V"},      {"°c", "degC"},         {"c", "degC"},
    {"celsius", "degC"},    {"mdegree", "mdeg"}, {"centimeter", "cm"},   {"centimetre", "cm"},
    {"decimeter", "dm"},    {"decimetre", "dm"}, {"micrometer", "um"},   {"micrometre", "um"},
    {"nanometer", "nm"},    {"nanometre", "nm"}, {"inches", "inch"},     {"meters", "m"},
    {"metres", "m"},        {"millimeters", "mm"}, {"millimetres", "mm"}, {"umdrehungen", "turn"},
    {"umdrehung", "turn"},  {"tr", "turn"},      {"tours", "turn"},      {"degrés", "deg"},
    {"degré", "deg"},       {"grados", "deg"},   {"gradi", "deg"},       {"bogensekunden", "arcsec"},
    {"arcs", "arcsec"},     {"arcminutes", "arcmin"}, {"bogenminuten", "arcmin"}, {"gons", "gon"},
    {"度", "deg"},          {"град", "deg"},     {"мм", "mm"},           {"мкм", "um"},
    {"mikrometer", "um"},   {"millisekunden", "ms"}, {"sekunden", "s"},  {"сек", "s"},
    {"thou", "mil"},        {"mils", "mil"},     {"uin", "uinch"},       {"µin", "uinch"},
    {"μin", "uinch"},       {"microinch", "uinch"}, {"microinches", "uinch"}, {"minute", "min"},
    {"rads", "rad"},        {"degs", "deg"},
});

/// Of rates that are not written as one unit over another.
constexpr std::array kRateSpellings = std::to_array<Spelling>({
    {"rpm", "turn_min"}, {"r/min", "turn_min"}, {"1/min", "turn_min"}, {"min-1", "turn_min"}, {"min^-1", "turn_min"},
    {"rps", "turn_s"},   {"r/s", "turn_s"},     {"dps", "deg_s"},      {"ipm", "inch_min"},
});

std::optional<NamedUnit> PlainUnit(std::string_view name) {
  const auto found = std::ranges::find(kUnits, name, &NamedUnit::name);
  if (found == kUnits.end()) return std::nullopt;
  return *found;
}

/// An angle or a length over a time, by the name of its key: "mm_min".
const std::vector<std::pair<std::string, NamedUnit>>& Rates() {
  static const auto rates = [] {
    std::vector<std::pair<std::string, NamedUnit>> all;
    for (const NamedUnit& over : kUnits) {
      for (const NamedUnit& unit : kUnits) {
        const bool is_length = unit.dimension == Dimension::kLength;
        if (over.dimension != Dimension::kTime || (!is_length && unit.dimension != Dimension::kAngle)) continue;
        all.push_back({std::string(unit.name) + "_" + std::string(over.name),
                       {"", is_length ? Dimension::kSpeed : Dimension::kTurning, unit.to_SI / over.to_SI}});
      }
    }
    for (auto& [name, rate] : all) rate.name = name;  // none is moved any more
    return all;
  }();
  return rates;  // constant
}

std::optional<NamedUnit> RateNamed(std::string_view name) {
  const auto found = std::ranges::find(Rates(), name, [](const auto& rate) { return std::string_view(rate.first); });
  return found == Rates().end() ? std::nullopt : std::optional(found->second);
}

/// "mm/min", "°/s", "RPM".
std::optional<NamedUnit> OverATime(std::string_view text) {
  const std::size_t slash = text.rfind('/');
  const auto spelling = std::ranges::find(kRateSpellings, SmallLetters(text), &Spelling::spelling);
  if (spelling != kRateSpellings.end()) return RateNamed(spelling->name);
  if (slash == std::string_view::npos) return RateNamed(text);
  const auto unit = UnitNamed(text.substr(0, slash)), over = UnitNamed(text.substr(slash + 1));
  return unit && over ? RateNamed(std::string(unit->name) + "_" + std::string(over->name)) : std::nullopt;
}

/// What stands inside a pair of brackets at the end.
std::optional<NameAndUnit> InBrackets(std::string_view field, char open, char close) {
  if (field.size() < 2 || field.back() != close) return std::nullopt;
  const std::size_t at = field.rfind(open);
  if (at == std::string_view::npos) return std::nullopt;
  return NameAndUnit{std::string(Trimmed(field.substr(0, at))),
                     std::string(Trimmed(field.substr(at + 1, field.size() - at - 2)))};
}

/// What stands in parentheses may be anything but a unit, "pos (2)": it is one that is not known only if it is something over a
/// time, or a usual unit of something else.
bool IsOtherUnit(std::string_view text) {
  constexpr std::array kOthers = std::to_array<std::string_view>({"mA", "Hz", "kHz", "Nm", "mNm", "kW", "Pa", "bar", "kg", "%"});
  const std::size_t slash = text.rfind('/');
  if (slash == std::string_view::npos) return std::ranges::find(kOthers, text) != kOthers.end();
  const auto over = UnitNamed(text.substr(slash + 1));
  return slash > 0 && over && over->dimension == Dimension::kTime;
}

/// "rad" of "Theta in rad"; else as it is.
std::string_view BehindIn(std::string_view text) {
  constexpr std::string_view kIn = " in ";
  const std::size_t in = text.rfind(kIn);
  const std::string_view behind = in == std::string_view::npos ? text : text.substr(in + kIn.size());
  return UnitNamed(behind) ? behind : text;
}

/// Words that are units in brackets only: "x min" is a smallest value, "measured as" no arc second.
bool IsWord(std::string_view text) {
  constexpr std::array kWords = std::to_array<std::string_view>({"in", "as", "min", "tr", "rev", "turn", "turns", "tours", "second"});
  return text.size() < 2 || std::ranges::find(kWords, SmallLetters(text)) != kWords.end();
}

/// "Position mm", "Angle, deg", "Winkel in Grad".
std::optional<NameAndUnit> BehindABlank(std::string_view field) {
  const std::size_t at = field.find_last_of(" ,");
  if (at == std::string_view::npos || at == 0) return std::nullopt;
  const std::string_view unit = field.substr(at + 1);
  if (IsWord(unit) || !UnitNamed(unit)) return std::nullopt;
  std::string_view name = Trimmed(field.substr(0, at));
  for (const std::string_view between : {",", " in"}) {
    if (name.ends_with(between) && name.size() > between.size()) name = Trimmed(name.substr(0, name.size() - between.size()));
  }
  return NameAndUnit{std::string(name), std::string(unit)};
}

/// "Measured Z [m] - Run 1": such a name is kept whole.
std::optional<NameAndUnit> InTheMiddle(std::string_view field) {
  const std::size_t open = field.find('['), close = field.find(']', std::min(open, field.size()));
  if (open == std::string_view::npos || open == 0 || close == std::string_view::npos) return std::nullopt;
  const std::string_view unit = Trimmed(field.substr(open + 1, close - open - 1));
  if (!UnitNamed(unit)) return std::nullopt;
  return NameAndUnit{std::string(field), std::string(unit)};
}

/// "angle_degrees", "positionRad": such a name is kept whole. "q_m" is a joint's at its motor.
std::optional<NameAndUnit> InTheName(std::string_view field) {
  if (field == "q_m" || field.ends_with("_q_m")) return std::nullopt;
  if (const auto plain = UnitAtEnd(field)) return NameAndUnit{std::string(field), std::string(plain->name)};
  std::size_t at = field.rfind('_');
  if (at == std::string_view::npos) {
    at = field.find_last_not_of("abcdefghijklmnopqrstuvwxyz");
    if (at != std::string_view::npos && std::isupper(static_cast<unsigned char>(field[at])) && at > 0) --at;
  }
  if (at == std::string_view::npos || at == 0) return std::nullopt;
  const bool turns = field[at] == '_' && (field.ends_with("_turns") || field.ends_with("_rev") || field.ends_with("_revs"));
  if (!turns && IsWord(field.substr(at + 1))) return std::nullopt;
  const auto unit = UnitNamed(field.substr(at + 1));
  if (!unit) return std::nullopt;
  return NameAndUnit{std::string(field), std::string(unit->name)};
}

}  // namespace

std::optional<NamedUnit> UnitNamed(std::string_view text) {
  text = Trimmed(text);
  if (const auto plain = PlainUnit(text)) return plain;
  const std::string small = SmallLetters(text);
  const auto spelling = std::ranges::find(kSpellings, small, &Spelling::spelling);
  if (spelling != kSpellings.end()) return PlainUnit(spelling->name);
  for (const NamedUnit& unit : kUnits) {
    const bool is_of_torque = small == "nm" && text.front() == 'N';
    if (SmallLetters(unit.name) == small && small != "mv" && small.size() > 1 && !is_of_torque) return unit;
  }
  return OverATime(text);
}

std::optional<NamedUnit> UnitAtEnd(std::string_view name) {
  const std::size_t at = name.rfind('_');
  if (at == std::string_view::npos || at == 0) return std::nullopt;
  const std::size_t before = name.rfind('_', at - 1);
  if (before != std::string_view::npos && before > 0) {
    if (const auto rate = RateNamed(name.substr(before + 1))) return rate;
  }
  return PlainUnit(name.substr(at + 1));
}

std::vector<NamedUnit> UnitsOf(Dimension dimension) {
  std::vector<NamedUnit> units;
  for (const auto& [name, rate] : Rates()) {
    if (rate.dimension == dimension) units.push_back(rate);
  }
  std::ranges::copy_if(kUnits, std::back_inserter(units),
                       [dimension](const NamedUnit& unit) { return unit.dimension == dimension; });
  return units;
}

std::string NearestUnit(std::string_view misspelt, const std::vector<Dimension>& dimensions) {
  const std::string small = SmallLetters(Trimmed(misspelt));
  std::string_view nearest;
  int least = small.size() > 3 ? 3 : 2;
  const auto look = [&](std::string_view spelling, std::string_view name) {
    const int distance = EditDistance(small, spelling);
    if (distance >= least || std::ranges::find(dimensions, PlainUnit(name)->dimension) == dimensions.end()) return;
    least = distance;
    nearest = name;
  };
  for (const NamedUnit& unit : kUnits) look(unit.name, unit.name);
  for (const Spelling& other : kSpellings) look(other.spelling, other.name);
  return nearest.empty() ? "" : "; the nearest is " + std::string(nearest);
}

NameAndUnit SplitHeader(std::string_view field) {
  field = Trimmed(field);
  for (const auto& [open, close] : {std::pair{'[', ']'}, std::pair{'(', ')'}, std::pair{'{', '}'}, std::pair{'<', '>'}}) {
    auto split = InBrackets(field, open, close);
    if (!split || split->name.empty()) continue;
    split->unit = BehindIn(split->unit);
    if (open == '[' || UnitNamed(split->unit) || IsOtherUnit(split->unit)) return *split;
  }
  const std::size_t slash = field.rfind('/');
  if (slash != std::string_view::npos && slash > 0 && UnitNamed(field.substr(slash + 1)))
    return {std::string(Trimmed(field.substr(0, slash))), std::string(Trimmed(field.substr(slash + 1)))};
  for (const auto& split : {BehindABlank(field), InTheMiddle(field), InTheName(field)}) {
    if (split) return *split;
  }
  return {std::string(field), ""};
}

std::optional<std::string> BareUnit(std::string_view field) {
  field = Trimmed(field);
  if (field.size() >= 2 &&
      ((field.front() == '[' && field.back() == ']') || (field.front() == '(' && field.back() == ')')))
    field = Trimmed(field.substr(1, field.size() - 2));
  if (field.empty() || field == "-" || field == "1") return std::string(field);
  if (UnitNamed(field)) return std::string(field);
  for (const std::string_view other :
       {"counts", "count", "steps", "step", "px", "A", "Hz", "Nm", "%"}) {
    if (field == other) return std::string(field);
  }
  return std::nullopt;
}

}  // namespace twinbench::imports
