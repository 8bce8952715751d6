#include "twin/core/number_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>

#include "twin/core/errors.h"

namespace twinbench {
namespace {

std::string_view Trim(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

template <class Number>
std::optional<Number> Parse(std::string_view text) {
  text = Trim(text);
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);  // from_chars knows no plus
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

int SignificantDigits(std::string_view text) {
  const std::string_view mantissa = text.substr(0, text.find_first_of("eE"));
  const auto first = mantissa.find_first_of("123456789");
  if (first == std::string_view::npos) return 0;
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  return static_cast<int>(std::count_if(mantissa.begin() + static_cast<long>(first), mantissa.end(), is_digit));
}

bool ReadsBack(const std::string& text, double to_SI, double value_SI) {
  const auto read = ParseInUnit(text, to_SI);
  return read && std::bit_cast<std::uint64_t>(*read) == std::bit_cast<std::uint64_t>(value_SI);
}

}  // namespace

std::optional<double> ParseNumber(std::string_view text) {
  const auto number = Parse<double>(text);
  return number && std::isfinite(*number) ? number : std::nullopt;
}

std::optional<long long> ParseWholeNumber(std::string_view text) {
  return Parse<long long>(text);
}

std::optional<std::uint64_t> ParseSeed(std::string_view text) {
  return Parse<std::uint64_t>(text);
}

std::optional<double> ParseInUnit(std::string_view text, double to_SI) {
  const auto number = ParseNumber(text);
  if (!number) return std::nullopt;
  if (SignificantDigits(text) <= 17) return *number * to_SI;
  const auto extended = Parse<long double>(text);
  return extended ? static_cast<double>(*extended * static_cast<long double>(to_SI)) : *number * to_SI;
}

std::string PrintInUnit(double value_SI, double to_SI) {
  Require(std::isfinite(value_SI), "a number to be written must be finite");
  const double number = value_SI / to_SI;
  if (const auto shortest = fmt::format("{}", number); ReadsBack(shortest, to_SI, value_SI) && shortest.size() < 17)
    return shortest;
  for (int digits = 15; digits <= 17; ++digits) {
    if (const auto text = fmt::format("{:.{}g}", number, digits); ReadsBack(text, to_SI, value_SI)) return text;
  }
  const long double extended = static_cast<long double>(value_SI) / static_cast<long double>(to_SI);
  for (int digits = 18; digits <= 20; ++digits) {  // zeros at the end stay: they say that it is to be read in extended precision
    if (const auto text = fmt::format("{:#.{}g}", extended, digits); ReadsBack(text, to_SI, value_SI)) return text;
  }
  return fmt::format("{:#.21g}", extended);  // 21 digits name every 64-bit mantissa
}

}  // namespace twinbench
