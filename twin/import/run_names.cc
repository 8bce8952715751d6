#include "twin/import/run_names.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <set>
#include <string>

#include "twin/import/column_words.h"
#include "twin/import/common.h"
#include "twin/import/text.h"
#include "twin/import/unit_names.h"

namespace twinbench::imports {
namespace {

bool HasAnyPart(const std::string& text, const std::vector<const char*>& words) {
  return std::ranges::any_of(words, [&text](const char* word) { return text.find(word) != std::string::npos; });
}

/// All names from there on say up or down, and both come.
bool RunsFrom(std::size_t first, const std::vector<std::string_view>& names) {
  int up = 0, down = 0;
  for (std::size_t c = first; c < names.size(); ++c) {
    const int direction = DirectionIn(SplitHeader(names[c]).name);
    if (direction == 0) return false;
    ++(direction > 0 ? up : down);
  }
  return up > 0 && down > 0;
}

/// "run 3", "Lauf 3", "3", "3rd": without its number; nothing is left of what is no run.
bool IsNumberedRun(std::string_view field, std::set<std::string>& different) {
  std::string name = SmallLetters(SplitHeader(field).name);
  const bool is_ordinal = name.size() > 2 && std::isdigit(static_cast<unsigned char>(name.front())) &&
                          std::ranges::any_of(std::array{"st", "nd", "rd", "th"}, [&name](const char* end) { return name.ends_with(end); });
  if (is_ordinal) name.resize(name.size() - 2);
  const std::size_t digits = name.find_first_of("0123456789");
  if (digits == std::string::npos || name.find_first_not_of("0123456789", digits) != std::string::npos) return false;
  std::string word = name.substr(0, digits);
  while (!word.empty() && std::string_view(" _-.#").find(word.back()) != std::string_view::npos) word.pop_back();
  constexpr std::array kRuns = {"", "run", "pass", "cycle", "trial", "rep", "repetition", "repeat", "series", "lauf", "durchgang", "zyklus", "messreihe", "reihe", "passage"};
  return std::ranges::find(kRuns, word) != kRuns.end() && different.insert(name).second;
}

/// What the runs go along: a target by its name, or an angle or a length.
bool IsCalledTarget(std::string_view field) {
  const NameAndUnit column = SplitHeader(field);
  const auto unit = UnitNamed(column.unit);
  const bool fits = !unit || unit->dimension == Dimension::kAngle || unit->dimension == Dimension::kLength;
  return fits && (unit || Clearness(column.name, Speaks::kReference) > 0 || Clearness(column.name, Speaks::kDevice) > 0);
}

}  // namespace

int DirectionIn(std::string_view text) {
  const std::string small = SmallLetters(text);
  const bool up =
      HasAnyPart(small, {"forward", "fwd", "up", "positive", "vorw", "↑", "pos. dir", "below", "von unten", "aller"}) || Trimmed(text).ends_with('+');
  const bool down = HasAnyPart(small, {"backward", "bwd", "down", "negative", "reverse", "rückw", "↓", "neg. dir", "above", "von oben", "retour"}) ||
                    Trimmed(text).ends_with('-');
  return up == down ? 0 : up ? 1 : -1;
}

bool CountsRows(std::string_view name) {
  const std::string small = SmallLetters(Trimmed(name));
  return small.empty() || small == "i" || small == "no" || small == "no." || small == "nr" || small == "#" ||
         small == "point" || small == "step" || small == "index" || small == "row" || small == "id";
}

bool IsOnePlace(const std::vector<std::string_view>& names) {
  return RunsFrom(!names.empty() && CountsRows(names[0]) ? 1 : 0, names);
}

bool NamesRuns(const std::vector<std::string_view>& names) {
  const std::size_t first = names.empty() || !CountsRows(names[0]) ? 0 : 1;
  return first < names.size() && DirectionIn(names[first]) == 0 && RunsFrom(first + 1, names);
}

bool NumbersARun(std::string_view name) {
  std::set<std::string> different;
  return !name.empty() && std::isalpha(static_cast<unsigned char>(name.front())) && IsNumberedRun(name, different);
}

bool NumbersRuns(const std::vector<std::string_view>& names) {
  const std::size_t first = names.empty() || !CountsRows(names[0]) ? 0 : 1;
  if (names.size() < first + 3 || !IsCalledTarget(names[first])) return false;
  std::set<std::string> different;
  return std::all_of(names.begin() + static_cast<std::ptrdiff_t>(first) + 1, names.end(),
                     [&different](std::string_view name) { return IsNumberedRun(name, different); });
}

}  // namespace twinbench::imports
