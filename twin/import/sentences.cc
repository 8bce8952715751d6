#include <algorithm>
#include <cctype>
#include <map>
#include <utility>

#include "twin/import/clock.h"
#include "twin/import/common.h"
#include "twin/import/gatherer.h"
#include "twin/import/layouts.h"
#include "twin/import/text.h"
#include "twin/import/unit_names.h"

namespace twinbench::imports {
namespace {

constexpr char kValue = '\1';  // in the words of a sentence

/// A line that says what its numbers are.
struct Sentence {
  std::string words;  // with a mark for each value
  std::vector<std::string_view> before, values;
};

bool IsDigit(char c) {
  return std::isdigit(static_cast<unsigned char>(c));
}

bool IsOfWord(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || static_cast<unsigned char>(c) >= 0x80;
}

bool BeginsNumber(std::string_view line, std::size_t at) {
  if (at > 0 && (IsOfWord(line[at - 1]) || line[at - 1] == '.')) return false;
  const std::size_t digit = line.find_first_not_of("+-.", at);
  return digit != std::string_view::npos && digit - at <= 2 && IsDigit(line[digit]);
}

/// "joint.0.pos-cmd +5,0 joint.0.pos-fb +5,03": numbers have no points.
bool HasDecimalCommas(std::string_view line) {
  bool is_comma = false;
  for (std::size_t i = 1; i + 1 < line.size(); ++i) {
    if (!IsDigit(line[i - 1]) || !IsDigit(line[i + 1])) continue;
    if (line[i] == '.') return false;
    is_comma = is_comma || line[i] == ',';
  }
  return is_comma;
}

/// Of digits and what stands between them in a number or an instant.
std::size_t EndOfValue(std::string_view line, std::size_t at, bool decimal_commas) {
  const std::string_view between = decimal_commas ? ",:/-+T" : ".:/-+T";
  std::size_t end = at + 1;
  for (; end < line.size(); ++end) {
    const char c = line[end], next = end + 1 < line.size() ? line[end + 1] : ' ';
    const bool is_exponent = (c == 'e' || c == 'E') && (IsDigit(next) || next == '-' || next == '+');
    if (!IsDigit(c) && !is_exponent && !(IsDigit(next) && between.find(c) != std::string_view::npos)) break;
  }
  return end;
}

/// "nan", as programs write it.
bool IsNone(std::string_view line, std::size_t at) {
  constexpr std::size_t kLetters = 3;
  const bool is_alone = (at == 0 || !IsOfWord(line[at - 1])) && (at + kLetters >= line.size() || !IsOfWord(line[at + kLetters]));
  return is_alone && SmallLetters(line.substr(at, kLetters)) == "nan";
}

/// A number, or an instant as a whole, at `at`; empty of "2: 5.0", which is one more word of a name, and of what is neither.
std::string_view ValueAt(std::string_view line, std::size_t at, bool decimal_commas) {
  if (IsNone(line, at)) return line.substr(at, 3);
  if (!BeginsNumber(line, at)) return {};
  const std::size_t end = EndOfValue(line, at, decimal_commas);
  const std::string_view value = line.substr(at, end - at);
  if (!FieldNumber(value, decimal_commas)) return ParseInstant(value) ? value : std::string_view();
  const std::size_t next = line.find_first_not_of(" \t", end);
  const bool is_of_name = at > 0 && value.find('.') == std::string_view::npos && next != std::string_view::npos && (line[next] == ':' || line[next] == '=');
  return is_of_name ? std::string_view() : value;
}

Sentence SentenceOf(std::string_view line) {
  const bool decimal_commas = HasDecimalCommas(line);
  Sentence sentence;
  std::size_t begin = 0;
  for (std::size_t at = 0; at < line.size();) {
    const std::string_view value = ValueAt(line, at, decimal_commas);
    if (value.empty()) {
      sentence.words += line[at++];
      continue;
    }
    sentence.words += kValue;
    sentence.before.push_back(line.substr(begin, at - begin));
    sentence.values.push_back(value);
    begin = at += value.size();
  }
  return sentence;
}

bool HasLetter(std::string_view text) {
  return std::ranges::any_of(text, [](char c) { return IsOfWord(c) && !IsDigit(c); });
}

/// The words that come most often around two values and more; nothing if they come less than three times.
std::pair<Sentence, std::size_t> UsualSentence(const std::vector<std::string_view>& lines) {
  std::map<std::string, std::pair<Sentence, std::size_t>> times;
  for (const std::string_view line : lines) {
    Sentence sentence = SentenceOf(line);
    if (sentence.values.size() < 2 || !HasLetter(sentence.words)) continue;
    auto& [first, count] = times[sentence.words];
    if (++count == 1) first = std::move(sentence);
  }
  const auto most = std::ranges::max_element(times, {}, [](const auto& entry) { return entry.second.second; });
  return most == times.end() || most->second.second < 3 ? std::pair<Sentence, std::size_t>() : most->second;
}

bool HasRows(const std::vector<std::string_view>& lines) {
  const Fields how = FindFields(lines, {});
  std::vector<std::string_view> fields;
  return how.separator != '\0' && std::ranges::any_of(lines, [&](std::string_view line) {
    Split(line, how.separator, fields);
    return !IsComment(line) && IsRow(fields, how);
  });
}

std::string_view WithoutMarks(std::string_view text) {
  constexpr std::string_view kMarks = " \t:=,;|()[]{}<>\"'-+/*";
  const std::size_t begin = text.find_first_not_of(kMarks);
  return begin == std::string_view::npos ? "" : text.substr(begin, text.find_last_not_of(kMarks) + 1 - begin);
}

/// What stands before each value, and the unit that stands behind it: "target [deg]" of "target: 5.0 deg, actual: 5.1 deg".
std::vector<std::string> NamesOf(const Sentence& sentence) {
  std::vector<std::string> names;
  for (const std::string_view before : sentence.before) {
    std::string_view name = before;
    const std::size_t mark = name.find_first_of(" \t,;|", name.find_first_not_of(" \t"));
    const std::string_view unit = mark == std::string_view::npos ? "" : WithoutMarks(name.substr(0, mark));
    if (!names.empty() && !unit.empty() && UnitNamed(std::string(unit))) {
      names.back() += " [" + std::string(unit) + "]";
      name.remove_prefix(mark);
    }
    name = WithoutMarks(name);
    names.push_back(HasLetter(name) ? std::string(name) : "column " + std::to_string(names.size() + 1));
  }
  return names;
}

}  // namespace

bool AreSentences(const std::vector<std::string_view>& lines) {
  const auto [usual, count] = UsualSentence(lines);
  if (count == 0) return false;
  const bool are_all_named = std::ranges::all_of(usual.before, HasLetter);
  return (are_all_named && 10 * count > 8 * lines.size()) || (3 * count > lines.size() && !HasRows(lines));
}

std::string TableOfSentences(std::string_view text) {
  const Sentence usual = UsualSentence(FirstLines(text)).first;
  std::string table;
  const auto add_row = [&table](const auto& fields) {
    for (std::size_t i = 0; i < fields.size(); ++i) table += (i > 0 ? "\t" : "") + std::string(fields[i]);
    table += "\n";
  };
  bool is_first = true;
  Lines lines(text);
  for (std::string_view line; lines.Next(line);) {
    const Sentence sentence = SentenceOf(line);
    if (sentence.words != usual.words) {
      table += std::string(line) + "\n";
      continue;
    }
    if (std::exchange(is_first, false)) add_row(NamesOf(usual));
    const std::size_t begin = table.size();
    add_row(sentence.values);
    std::replace(table.begin() + static_cast<std::ptrdiff_t>(begin), table.end(), ',', '.');
  }
  return table;
}

}  // namespace twinbench::imports
