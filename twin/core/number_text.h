#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

/// Numbers as the text of our files: decimal, `.` as point, no locale.
namespace twinbench {

/// @return the number in `text` (all of it, blanks at the ends aside), or nothing if it is not a finite number.
std::optional<double> ParseNumber(std::string_view text);

/// @return the whole number in `text`, or nothing.
std::optional<long long> ParseWholeNumber(std::string_view text);

/// @return the whole number without sign in `text`, up to 2^64 - 1, or nothing.
std::optional<std::uint64_t> ParseSeed(std::string_view text);

/// The number in `text` times `to_SI`.
///
/// Up to 17 significant digits name a double, and the product is that of two doubles. More digits are taken in
/// extended precision and rounded once, after the product: with some factors no double times the factor gives
/// every SI value, and this is how PrintInUnit still writes those.
std::optional<double> ParseInUnit(std::string_view text, double to_SI);

/// The shortest of our notations that ParseInUnit turns back into the same bits.
/// @throws std::logic_error if `value_SI` is not finite.
std::string PrintInUnit(double value_SI, double to_SI);

}  // namespace twinbench
