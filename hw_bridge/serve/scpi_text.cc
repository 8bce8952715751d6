#include "hw_bridge/serve/scpi_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>

#include "hw_bridge/serve/words.h"
#include "twin/core/number_text.h"

namespace twinbench::hw {
namespace {

constexpr std::size_t kLongestQueue = 20;

struct ScpiErrorEntry {
  int number;
  const char* text;
};
constexpr std::array kErrorTexts = {ScpiErrorEntry{-102, "Syntax error"},
                                    ScpiErrorEntry{-108, "Parameter not allowed"},
                                    ScpiErrorEntry{-109, "Missing parameter"},
                                    ScpiErrorEntry{-113, "Undefined header"},
                                    ScpiErrorEntry{-114, "Header suffix out of range"},
                                    ScpiErrorEntry{-120, "Numeric data error"},
                                    ScpiErrorEntry{-203, "Command protected"},
                                    ScpiErrorEntry{-221, "Settings conflict"},
                                    ScpiErrorEntry{-222, "Data out of range"},
                                    ScpiErrorEntry{-224, "Illegal parameter value"},
                                    ScpiErrorEntry{-240, "Hardware error"},
                                    ScpiErrorEntry{-241, "Hardware missing"},
                                    ScpiErrorEntry{-350, "Queue overflow"},
                                    ScpiErrorEntry{-363, "Input buffer overrun"}};

bool IsWord(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

std::string ShortForm(std::string_view pattern) {
  std::string capitals;
  for (const char c : pattern) {
    if (c == '*' || std::isupper(static_cast<unsigned char>(c))) capitals += c;
  }
  return capitals;
}

}  // namespace

std::optional<ScpiUnit> ParseScpiUnit(const std::string& text) {
  ScpiUnit unit;
  const auto blank = text.find_first_of(" \t");
  std::string header = text.substr(0, blank);
  if (!header.empty() && header.back() == '?') {
    unit.query = true;
    header.pop_back();
  }
  unit.rooted = header.starts_with(':') || header.starts_with('*');
  if (header.starts_with(':')) header.erase(0, 1);
  unit.header = SplitOutsideQuotes(header, ':');
  for (const std::string& keyword : unit.header) {
    const std::string_view word = std::string_view(keyword).substr(keyword.starts_with('*') ? 1 : 0);
    if (word.empty() || !std::ranges::all_of(word, IsWord)) return std::nullopt;
  }
  if (blank != std::string::npos) unit.parameters = SplitOutsideQuotes(text.substr(blank), ',');
  return unit;
}

std::optional<int> MatchKeyword(std::string_view pattern, std::string_view keyword) {
  const bool numbered = pattern.ends_with('#');
  if (numbered) pattern.remove_suffix(1);
  const auto digits = keyword.find_first_of("0123456789");
  const std::string word = UpperCase(keyword.substr(0, digits));
  if (word != UpperCase(pattern) && word != ShortForm(pattern)) return std::nullopt;
  if (digits == std::string_view::npos) return numbered ? 1 : 0;
  const auto number = ParseWholeNumber(keyword.substr(digits));
  if (!numbered || !number || *number < 0 || *number > 99) return std::nullopt;
  return static_cast<int>(*number);
}

std::optional<int> MatchHeader(std::string_view pattern, const std::vector<std::string>& header) {
  const std::vector<std::string> wanted = SplitOutsideQuotes(pattern, ':');
  if (wanted.size() != header.size()) return std::nullopt;
  int number = 0;
  for (std::size_t k = 0; k < wanted.size(); ++k) {
    const auto found = MatchKeyword(wanted[k], header[k]);
    if (!found) return std::nullopt;
    number = std::max(number, *found);
  }
  return number;
}

const char* ScpiErrorText(int number) {
  const auto found = std::ranges::find(kErrorTexts, number, &ScpiErrorEntry::number);
  return found == kErrorTexts.end() ? "Command error" : found->text;
}

void ScpiErrorQueue::Add(const ScpiError& error) {
  if (entries_.size() < kLongestQueue) {
    entries_.push_back(error);
  } else {
    entries_.back() = {-350, ""};
  }
}

std::string ScpiErrorQueue::Next() {
  if (entries_.empty()) return "0,\"No error\"";
  const ScpiError error = entries_.front();
  entries_.pop_front();
  const std::string detail = error.detail.empty() ? "" : ";" + error.detail;
  return fmt::format("{},\"{}{}\"", error.number, ScpiErrorText(error.number), detail);
}

}  // namespace twinbench::hw
