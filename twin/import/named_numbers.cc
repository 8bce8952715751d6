#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>

#include "twin/import/common.h"
#include "twin/import/table.h"
#include "twin/import/text.h"

namespace twinbench::imports {
namespace {

/// Up to the number, within its clause.
std::string_view ClauseBefore(std::string_view line, std::size_t at) {
  const std::size_t mark = line.substr(0, at).find_last_of(",;=\t");
  return line.substr(mark == std::string_view::npos ? 0 : mark + 1, mark == std::string_view::npos ? at : at - mark - 1);
}

/// "a turn", "per rev", "/U": of what stands behind "counts: 4096".
bool BeginsPerTurn(const std::string& behind) {
  return std::ranges::any_of(std::array{"a turn", "a rev", "per ", "/", "each "}, [&behind](const char* word) { return behind.starts_with(word); });
}

/// "2^20" where 20 stands behind "2^", and "20 bit": a power of two.
std::optional<double> PowerOfTwo(std::string_view before, std::string_view digits, const std::string& behind) {
  constexpr double kMostBits = 32.0;
  const auto bits = FieldNumber(digits, false);
  const bool is_one = before.ends_with("2^") || behind.starts_with("bit") || behind.starts_with("-bit");
  return is_one && bits && *bits <= kMostBits ? std::optional(std::exp2(*bits)) : std::nullopt;
}

/// "encoder of 4096 counts/rev", "1440 counts per revolution", "4000cpr", "counts of 4096 a turn": a number that says what it
/// is behind it, or before and behind it.
void AddNumbersPerTurn(std::string_view line, Track& track) {
  constexpr std::string_view kDigits = "0123456789";
  for (std::size_t at = 0; (at = line.find_first_of(kDigits, at)) != std::string_view::npos;) {
    const std::size_t end = std::min(line.find_first_not_of(kDigits, at), line.size());
    const std::string_view digits = line.substr(at, end - at), behind = Trimmed(line.substr(end)).substr(0, 40);
    const std::string what = SmallLetters(behind.substr(0, behind.find_first_of(",;=\t")));
    const bool says = SaysPerTurn(what) || (BeginsPerTurn(what) && SaysPerTurn(SmallLetters(ClauseBefore(line, at)) + what));
    const auto power = PowerOfTwo(line.substr(0, at), digits, what);
    const auto number = power ? power : FieldNumber(digits, false);
    if (number && says && !behind.starts_with('^')) track.numbers[SaysPerTurn(what) ? what : "counts " + what] = *number;
    at = end;
  }
}

}  // namespace

bool SaysPerTurn(const std::string& small) {
  const auto speaks = [&small](const auto& words) {
    return std::ranges::any_of(words, [&small](const char* word) { return small.find(word) != std::string::npos; });
  };
  return speaks(std::array{"cpr", "ppr"}) || (speaks(std::array{"count", "cts", "tick", "pulse", "step", "incr", "resolution"}) &&
                                              speaks(std::array{"turn", "rev", "umdr"}));
}

void AddNumbers(std::string_view line, Track& track) {
  AddNumbersPerTurn(line, track);
  while (!line.empty()) {
    const std::size_t comma = line.find_first_of(",;\t");
    const std::string_view part = line.substr(0, comma);
    line.remove_prefix(comma == std::string_view::npos ? line.size() : comma + 1);
    const std::size_t equals = part.find_first_of("=:");
    if (equals == std::string_view::npos) continue;
    std::string_view value = Trimmed(part.substr(equals + 1));
    value = value.substr(0, value.find_first_of(" \t\"%"));
    if (const auto number = FieldNumber(value, false))
      track.numbers[std::string(Trimmed(part.substr(0, equals)))] = *number;
  }
}

}  // namespace twinbench::imports
