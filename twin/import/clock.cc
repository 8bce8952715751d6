#include "twin/import/clock.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cmath>

#include "twin/import/common.h"
#include "twin/import/unit_names.h"

namespace twinbench::imports {
namespace {

/// Takes a whole number off the front.
std::optional<int> TakeNumber(std::string_view& text) {
  int number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc()) return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return number;
}

bool Take(std::string_view& text, char c) {
  if (text.empty() || text.front() != c) return false;
  text.remove_prefix(1);
  return true;
}

std::optional<double> DaySeconds(int year, int month, int day) {
  const std::chrono::year_month_day date{std::chrono::year(year), std::chrono::month(static_cast<unsigned>(month)),
                                         std::chrono::day(static_cast<unsigned>(day))};
  if (!date.ok()) return std::nullopt;
  return 86400.0 * static_cast<double>(std::chrono::sys_days(date).time_since_epoch().count());
}

/// The date at the front, as seconds since 1970.
std::optional<double> TakeDate(std::string_view& text) {
  std::string_view rest = text;
  const auto a = TakeNumber(rest);
  if (!a || rest.empty()) return std::nullopt;
  const char separator = rest.front();
  if (separator != '-' && separator != '.' && separator != '/') return std::nullopt;
  rest.remove_prefix(1);
  const auto b = TakeNumber(rest);
  if (!b || !Take(rest, separator)) return std::nullopt;
  const auto c = TakeNumber(rest);
  if (!c || *a < 0 || *b < 0 || *c < 0) return std::nullopt;
  std::optional<double> day_s;
  if (*a > 31) {
    day_s = DaySeconds(*a, *b, *c);
  } else if (*c > 31 && separator == '/') {
    day_s = DaySeconds(*c, *a, *b);  // the American order
  } else if (*c > 31) {
    day_s = DaySeconds(*c, *b, *a);
  }
  if (day_s) text = rest;
  return day_s;
}

double Fraction(std::string_view& text) {
  double fraction = 0.0, place = 0.1;
  while (!text.empty() && text.front() >= '0' && text.front() <= '9') {
    fraction += place * (text.front() - '0');
    place *= 0.1;
    text.remove_prefix(1);
  }
  return fraction;
}

/// Seconds since midnight at the front.
std::optional<double> TakeTimeOfDay(std::string_view& text) {
  const auto hour = TakeNumber(text);
  if (!hour || !Take(text, ':')) return std::nullopt;
  const auto minute = TakeNumber(text);
  if (!minute) return std::nullopt;
  double second_s = 0.0;
  if (Take(text, ':')) {
    const auto second = TakeNumber(text);
    if (!second) return std::nullopt;
    second_s = *second;
    if (!text.empty() && (text.front() == '.' || text.front() == ',' || text.front() == ':')) {
      text.remove_prefix(1);
      second_s += Fraction(text);
    }
  }
  if (*hour > 24 || *minute > 59 || second_s >= 61.0) return std::nullopt;
  return 3600.0 * *hour + 60.0 * *minute + second_s;
}

/// Half a day for "PM", and the offset of a zone, which is to be taken off.
std::optional<double> TakeZone(std::string_view text, double day_s) {
  while (Take(text, ' ')) {
  }
  if (text.empty() || text == "Z") return 0.0;
  if (text == "AM" || text == "am") return day_s >= 43200.0 ? -43200.0 : 0.0;
  if (text == "PM" || text == "pm") return day_s < 43200.0 ? 43200.0 : 0.0;
  if (text.front() != '+' && text.front() != '-') return std::nullopt;
  const double sign = text.front() == '+' ? -1.0 : 1.0;
  text.remove_prefix(1);
  const auto hours = TakeNumber(text);
  if (!hours) return std::nullopt;
  if (*hours > 99) return sign * (3600.0 * (*hours / 100) + 60.0 * (*hours % 100));
  const int minutes = Take(text, ':') ? TakeNumber(text).value_or(0) : 0;
  return text.empty() ? std::optional(sign * (3600.0 * *hours + 60.0 * minutes)) : std::nullopt;
}

NumberClock Epoch(const char* words, double to_s) {
  return {words, to_s, 0.0, true};
}

/// By the size of the numbers: today's in seconds are 1.7e9, and so on.
NumberClock ClockBySize(double typical) {
  const auto in = [typical](double low, double high) { return typical >= low && typical < high; };
  if (in(1.1e17, 1.6e17)) return {"Windows file time, 100 ns since 1601", 1e-7, kFileTimeOf1970, true};
  if (in(6e17, 4e18)) return Epoch("ns since 1970", 1e-9);
  if (in(6e14, 4e15)) return Epoch("us since 1970", 1e-6);
  if (in(6e11, 4e12)) return Epoch("ms since 1970", 1e-3);
  if (in(6e8, 4e9)) return Epoch("s since 1970", 1.0);
  return {"s", 1.0, 0.0, false};
}

}  // namespace

std::optional<Instant> ParseInstant(std::string_view text) {
  while (Take(text, ' ')) {
  }
  const std::optional<double> date_s = TakeDate(text);
  if (date_s && !Take(text, 'T') && !Take(text, ' ') && !Take(text, '_'))
    return text.empty() ? std::optional<Instant>({*date_s, true}) : std::nullopt;
  while (Take(text, ' ')) {
  }
  const std::optional<double> day_s = TakeTimeOfDay(text);
  if (!day_s) return std::nullopt;
  const std::optional<double> zone_s = TakeZone(text, *day_s);
  if (!zone_s) return std::nullopt;
  return Instant{date_s.value_or(0.0) + *day_s + *zone_s, date_s.has_value()};
}

std::optional<NumberClock> ClockOf(const std::vector<double>& numbers, const std::string& unit) {
  const auto first = std::ranges::find_if(numbers, [](double x) { return std::isfinite(x); });
  const NumberClock by_size = ClockBySize(first == numbers.end() ? 0.0 : *first);
  if (unit.empty() || unit == "epoch") return by_size;
  if (unit == "filetime") return NumberClock{"Windows file time, 100 ns since 1601", 1e-7, kFileTimeOf1970, true};
  const auto named = UnitNamed(unit);
  if (!named || named->dimension != Dimension::kTime) return std::nullopt;
  // A stamp keeps its origin if its unit is the one that its size speaks of.
  if (by_size.absolute && std::abs(by_size.to_s / named->to_SI - 1.0) < 1e-9) return by_size;
  return NumberClock{std::string(named->name), named->to_SI, 0.0, false};
}

}  // namespace twinbench::imports
