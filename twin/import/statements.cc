#include "twin/import/statements.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <functional>

#include "twin/core/reading.h"
#include "twin/import/column_words.h"
#include "twin/import/common.h"
#include "twin/import/text.h"

namespace twinbench::imports {
namespace {

bool IsLetter(char c) {
  return std::isalpha(static_cast<unsigned char>(c)) || static_cast<unsigned char>(c) >= 0x80;
}

/// Where a word stands as a whole word, and not within another.
std::size_t FindWord(const std::string& small, const std::string& word) {
  for (std::size_t at = 0; (at = small.find(word, at)) != std::string::npos; at += word.size()) {
    const std::size_t end = at + word.size();
    if (!(at > 0 && IsLetter(small[at - 1])) && !(end < small.size() && IsLetter(small[end]))) return at;
  }
  return std::string::npos;
}

/// The unit that stands before a number: "[mm]:", "_mm =", "in mm".
std::string UnitBefore(std::string_view between) {
  for (const auto& [open, close] : {std::pair{'[', ']'}, std::pair{'(', ')'}}) {
    const std::size_t from = between.find(open), to = between.find(close);
    if (from < to && to != std::string_view::npos) return std::string(Trimmed(between.substr(from + 1, to - from - 1)));
  }
  const std::size_t end = between.find_last_not_of(" :=;,|\t\"");
  if (end == std::string_view::npos) return "";
  between = between.substr(0, end + 1);
  if (between.starts_with('_')) return std::string(between.substr(1));
  return std::string(between.substr(between.find_last_of(" \t") + 1));
}

/// "1000 mm/min" without the number: up to the next field.
std::string UnitBehind(std::string_view rest) {
  const std::size_t begin = rest.find_first_not_of(" \t[(;,|\"");
  if (begin == std::string_view::npos) return "";
  rest = rest.substr(begin);
  return std::string(rest.substr(0, rest.find_first_of(" \t])(;,|\"")));
}

/// A decimal mark of either kind: text above a table often has another than its rows.
std::optional<double> AnyNumber(std::string_view digits) {
  while (!digits.empty() && std::string_view(".,'+-").find(digits.back()) != std::string_view::npos) digits.remove_suffix(1);
  for (const bool comma : {false, true}) {
    if (const auto number = FieldNumber(digits, comma)) return number;
  }
  return std::nullopt;
}

/// "29/2", "31:16" without the first number.
std::optional<double> DivisorBehind(std::string_view rest) {
  rest = Trimmed(rest);
  if (rest.empty() || (rest.front() != '/' && rest.front() != ':')) return std::nullopt;
  rest = Trimmed(rest.substr(1));
  const auto divisor = AnyNumber(rest.substr(0, rest.find_first_not_of("0123456789.,")));
  return divisor && *divisor > 0.0 ? divisor : std::nullopt;
}

std::optional<NamedUnit> Fitting(const std::string& unit, Dimension dimension) {
  const auto named = UnitNamed(unit);
  return named && named->dimension == dimension ? named : std::nullopt;
}

/// @param said  What one line says; nothing: not this.
std::vector<double> Held(const Track& track, const std::function<std::optional<double>(const std::string&)>& said) {
  std::vector<double> values(track.Rows(), kNaN);
  for (const TextLine& line : track.lines) {
    if (const auto value = said(line.text))
      std::fill(values.begin() + static_cast<std::ptrdiff_t>(std::min(line.row, values.size())), values.end(), *value);
  }
  return values;
}

}  // namespace

std::string OneQuantity(std::string_view text) {
  constexpr int kFewest = 5;
  std::string quantity;
  int count = 0;
  Lines lines(text);
  for (std::string_view line; lines.Next(line);) {
    if (Trimmed(line).empty()) continue;
    const std::size_t mark = line.find_last_of(":=");
    if (mark == std::string_view::npos || !AnyNumber(Trimmed(line.substr(mark + 1)))) return "";
    const std::string name(Trimmed(line.substr(0, mark)));
    if (name.empty() || (count++ > 0 && name != quantity)) return "";
    quantity = name;
  }
  return count < kFewest ? "" : quantity;
}

std::optional<Statement> StatementIn(const std::string& line, const std::string& word, Dimension dimension) {
  constexpr std::size_t kShortWord = 2, kFarthest = 40;
  const std::size_t at = FindWord(SmallLetters(line), word);
  if (at == std::string::npos) return std::nullopt;
  const std::string_view rest = std::string_view(line).substr(at + word.size());
  const std::size_t begin = rest.find_first_of("0123456789");
  if (begin == std::string_view::npos || begin > kFarthest) return std::nullopt;
  std::string_view between = rest.substr(0, begin);
  if (word.size() <= kShortWord && between.find_first_of("=:[(") == std::string_view::npos) return std::nullopt;
  const bool negative = between.ends_with('-');
  const std::size_t end = std::min(rest.find_first_not_of("0123456789.,'eE+-", begin), rest.size());
  const auto number = AnyNumber(rest.substr(begin, end - begin));
  if (!number) return std::nullopt;
  if (dimension == Dimension::kPure) {
    if (const auto divisor = DivisorBehind(rest.substr(end))) return Statement{(negative ? -*number : *number) / *divisor, ""};
  }
  for (const std::string& unit : {UnitBehind(rest.substr(end)), UnitBefore(between)}) {
    if (Fitting(unit, dimension)) return Statement{negative ? -*number : *number, unit};
    if (UnitNamed(unit)) return std::nullopt;  // of another quantity
  }
  return Statement{negative ? -*number : *number, ""};
}

std::vector<double> StatedValues(const Track& track, const std::vector<std::string>& words, const NamedUnit& to) {
  for (const std::string& word : words) {
    const std::vector<double> values = Held(track, [&](const std::string& line) -> std::optional<double> {
      const auto statement = StatementIn(line, word, to.dimension);
      if (!statement) return std::nullopt;
      const auto unit = Fitting(statement->unit, to.dimension);
      return unit ? statement->number * unit->to_SI / to.to_SI : statement->number;
    });
    if (std::ranges::any_of(values, [](double x) { return std::isfinite(x); })) return values;
  }
  return {};
}

std::vector<double> StatedTurns(const Track& track) {
  const std::vector<double> turns = Held(track, [](const std::string& line) -> std::optional<double> {
    const int turn = TurnIn(line);
    return turn == 0 ? std::nullopt : std::optional<double>(turn);
  });
  const bool all = std::ranges::all_of(turns, [](double x) { return std::isfinite(x); });
  return all ? turns : std::vector<double>();
}

}  // namespace twinbench::imports
