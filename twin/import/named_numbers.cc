#include <algorithm>
#include <array>
#include <string>

#include "twin/import/common.h"
#include "twin/import/table.h"
#include "twin/import/text.h"

namespace twinbench::imports {
namespace {

/// "4096 counts/rev": a number that says what it is behind it.
void AddNumberBefore(std::string_view part, Track& track) {
  const std::size_t end = part.find_first_of(" \t");
  if (end == std::string_view::npos) return;
  const std::string what = SmallLetters(Trimmed(part.substr(end)));
  const bool per_turn = std::ranges::any_of(std::array{"/rev", "/turn", "/umdr", "per rev", "per turn", "cpr", "ppr"},
                                            [&what](const char* word) { return what.find(word) != std::string::npos; });
  const auto number = FieldNumber(part.substr(0, end), false);
  if (per_turn && number) track.numbers[what] = *number;
}

}  // namespace

void AddNumbers(std::string_view line, Track& track) {
  while (!line.empty()) {
    const std::size_t comma = line.find_first_of(",;\t");
    const std::string_view part = line.substr(0, comma);
    line.remove_prefix(comma == std::string_view::npos ? line.size() : comma + 1);
    const std::size_t equals = part.find_first_of("=:");
    AddNumberBefore(Trimmed(equals == std::string_view::npos ? part : part.substr(equals + 1)), track);
    if (equals == std::string_view::npos) continue;
    std::string_view value = Trimmed(part.substr(equals + 1));
    value = value.substr(0, value.find_first_of(" \t\"%"));
    if (const auto number = FieldNumber(value, false))
      track.numbers[std::string(Trimmed(part.substr(0, equals)))] = *number;
  }
}

}  // namespace twinbench::imports
