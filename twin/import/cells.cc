#include <array>
#include <cctype>
#include <cmath>

#include "twin/import/text.h"
#include "twin/import/unit_names.h"

namespace twinbench::imports {
namespace {

bool TakeAny(std::string_view& text, std::initializer_list<std::string_view> marks) {
  text = Trimmed(text);
  for (const std::string_view mark : marks) {
    if (!text.starts_with(mark)) continue;
    text = Trimmed(text.substr(mark.size()));
    return true;
  }
  return false;
}

/// The digits at the front, with their decimal mark.
std::optional<double> TakeDigits(std::string_view& text, bool decimal_comma) {
  const std::size_t end = std::min(text.find_first_not_of("0123456789.,"), text.size());
  const auto number = FieldNumber(text.substr(0, end), decimal_comma);
  if (number) text.remove_prefix(end);
  return number;
}

/// "-12° 30' 4.5\"": the sign is of the whole.
std::optional<double> DegreesMinutesSeconds(std::string_view text, bool decimal_comma) {
  const bool negative = TakeAny(text, {"-", "\xE2\x88\x92"});
  const auto degrees = TakeDigits(text, decimal_comma);
  if (!degrees || !TakeAny(text, {"°", "º", "d"})) return std::nullopt;
  double angle_deg = *degrees;
  if (const auto minutes = TakeDigits(text, decimal_comma); minutes && !text.empty()) {
    if (*minutes >= 60.0 || !TakeAny(text, {"'", "′", "m"})) return std::nullopt;
    angle_deg += *minutes / 60.0;
  }
  if (const auto seconds = TakeDigits(text, decimal_comma)) {
    if (*seconds > 60.0 || !TakeAny(text, {"\"", "″", "''", "s"})) return std::nullopt;
    angle_deg += *seconds / 3600.0;
  }
  TakeAny(text, {"\""});  // a quote that a CSV writer doubled
  if (!text.empty()) return std::nullopt;
  return negative ? -angle_deg : angle_deg;
}

}  // namespace

std::optional<double> DegreesOfColons(std::string_view field, bool decimal_comma) {
  field = Trimmed(field);
  const bool negative = TakeAny(field, {"-", "\xE2\x88\x92"});
  if (!negative) TakeAny(field, {"+"});
  const std::size_t first = field.find(':'), second = field.find(':', first + 1);
  if (first == std::string_view::npos || second == std::string_view::npos || first > 4) return std::nullopt;
  const auto degrees = FieldNumber(field.substr(0, first), decimal_comma);
  const auto minutes = FieldNumber(field.substr(first + 1, second - first - 1), decimal_comma), seconds = FieldNumber(field.substr(second + 1), decimal_comma);
  if (!degrees || !minutes || !seconds || *minutes < 0.0 || *minutes >= 60.0 || *seconds < 0.0 || *seconds > 60.0) return std::nullopt;
  const double angle_deg = *degrees + *minutes / 60.0 + *seconds / 3600.0;
  return negative ? -angle_deg : angle_deg;
}

std::optional<Cell> CellOf(std::string_view field, bool decimal_comma) {
  if (const auto number = FieldNumber(field, decimal_comma)) return Cell{*number, ""};
  const bool may_be = !field.empty() && (std::isdigit(static_cast<unsigned char>(field.front())) || field.front() == '-' || field.front() == '+' ||
                                         field.front() == '\xE2');
  if (!may_be) return std::nullopt;
  const std::size_t end = field.find_last_of("0123456789");
  if (end != std::string_view::npos && end + 1 < field.size()) {
    const std::string_view unit = Trimmed(field.substr(end + 1));
    const auto number = FieldNumber(Trimmed(field.substr(0, end + 1)), decimal_comma);
    if (number && UnitNamed(unit)) return Cell{*number, unit};
  }
  const auto angle_deg = DegreesMinutesSeconds(field, decimal_comma);
  return angle_deg ? std::optional(Cell{*angle_deg, "deg"}) : std::nullopt;
}

}  // namespace twinbench::imports
