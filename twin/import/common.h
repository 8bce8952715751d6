#pragma once

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

/// Small things that several sources of this room need.
namespace twinbench::imports {

inline constexpr double kGapIntervals = 5.0;                     // a gap is longer than this many usual intervals
inline constexpr double kFileTimeOf1970 = 116444736000000000.0;  // Windows counts 100 ns since 1601

/// Latin letters with accents, Greek and Cyrillic ones too.
inline std::string SmallLetters(std::string_view text) {
  std::string small(text);
  std::ranges::transform(small, small.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  for (std::size_t i = 0; i + 1 < small.size(); ++i) {
    const auto lead = static_cast<unsigned char>(small[i]), letter = static_cast<unsigned char>(small[i + 1]);
    const bool is_accented = lead == 0xC3 && letter >= 0x80 && letter <= 0x9E && letter != 0x97;
    const bool is_greek = lead == 0xCE && letter >= 0x91 && letter <= 0x9F, is_cyrillic = lead == 0xD0 && letter >= 0x90 && letter <= 0x9F;
    if (is_accented || is_greek || is_cyrillic) small[i + 1] = static_cast<char>(letter + 0x20);
    if (lead != 0xD0 || letter < 0xA0 || letter > 0xAF) continue;  // the second half of the Cyrillic ones begins with another byte
    small[i] = static_cast<char>(0xD1);
    small[i + 1] = static_cast<char>(letter - 0x20);
  }
  return small;
}

/// 0 of nothing.
inline double QuantileOf(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::ranges::nth_element(values, at);
  return *at;
}
inline double MedianOf(std::vector<double> values) {
  return QuantileOf(std::move(values), 0.5);
}

/// From each number to the next, where both are numbers.
inline std::vector<double> StepsOf(const std::vector<double>& values) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < values.size(); ++i) {
    if (std::isfinite(values[i] - values[i - 1])) steps.push_back(values[i] - values[i - 1]);
  }
  return steps;
}

/// SimpleFOC prints a table of errors as uint16_t: 32768 is none, 65536 would be a turn.
inline bool AreErrorsOf16Bit(const std::vector<double>& entries) {
  constexpr double kNone = 32768.0, kLargest = 8192.0;
  return !entries.empty() && std::ranges::all_of(entries, [](double x) { return x == std::round(x) && std::abs(x - kNone) < kLargest; });
}

}  // namespace twinbench::imports
