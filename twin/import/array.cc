#include "twin/import/array.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "twin/core/errors.h"
#include "twin/import/table.h"
#include "twin/import/text.h"

namespace twinbench::imports {
namespace {

std::string WithoutComments(std::string_view text) {
  std::string code;
  code.reserve(text.size());
  for (std::size_t at = 0; at < text.size();) {
    if (text.substr(at, 2) == "/*") {
      at = std::min(text.find("*/", at + 2), text.size() - 2) + 2;
    } else if (text.substr(at, 2) == "//") {
      at = std::min(text.find('\n', at), text.size());
    } else {
      code += text[at++];
    }
  }
  return code;
}

bool IsLetter(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) || c == '_';
}

/// The word that ends before `at`, blanks aside.
std::string WordBefore(std::string_view code, std::size_t at) {
  while (at > 0 && std::isspace(static_cast<unsigned char>(code[at - 1]))) --at;
  std::size_t begin = at;
  while (begin > 0 && IsLetter(code[begin - 1])) --begin;
  return std::string(code.substr(begin, at - begin));
}

std::vector<double> NumbersIn(std::string_view list) {
  std::vector<double> numbers;
  while (!list.empty()) {
    const std::size_t end = std::min(list.find_first_of(", \t\r\n{}"), list.size());
    std::string_view field = list.substr(0, end);
    while (field.ends_with('f') || field.ends_with('F') || field.ends_with('u') || field.ends_with('U'))
      field.remove_suffix(1);
    if (const auto number = FieldNumber(field, false)) numbers.push_back(*number);
    list.remove_prefix(std::min(end + 1, list.size()));
  }
  return numbers;
}

/// name[...] = { numbers }: every one in the text.
std::vector<Column> ArraysIn(std::string_view code) {
  std::vector<Column> arrays;
  for (std::size_t brace = 0; (brace = code.find('{', brace)) != std::string_view::npos; ++brace) {
    const std::size_t equals = code.find_last_not_of(" \t\r\n", brace - (brace > 0 ? 1 : 0));
    if (brace == 0 || equals == std::string_view::npos || equals == 0 || code[equals] != '=') continue;
    const std::size_t close = code.find_last_not_of(" \t\r\n", equals - 1);
    if (close == std::string_view::npos || code[close] != ']') continue;
    const std::size_t open = code.rfind('[', close);
    if (open == std::string_view::npos) continue;
    const std::size_t end = std::min(code.find('}', brace), code.size());
    Column array{WordBefore(code, open), "", NumbersIn(code.substr(brace + 1, end - brace - 1)), {}};
    if (!array.value.empty()) arrays.push_back(std::move(array));
  }
  return arrays;
}

}  // namespace

void ReadArray(std::string_view text, const std::string& name, Recording& recording) {
  const std::string code = WithoutComments(text);
  std::vector<Column> arrays = ArraysIn(code);
  const auto found = name.empty()
                         ? std::ranges::max_element(arrays, {}, [](const Column& a) { return a.value.size(); })
                         : std::ranges::find(arrays, name, &Column::name);
  if (found == arrays.end())
    throw InputError(recording.file, name.empty() ? "no array of numbers" : "no array called " + name,
                     "name[...] = { numbers }");
  Track track;
  track.name = found->name;
  Lines lines(code);
  for (std::string_view line; lines.Next(line);) {
    if (const std::size_t equals = line.find('=');
        equals != std::string_view::npos && line.find('{') == std::string_view::npos) {
      const std::string word = WordBefore(line, equals);
      const std::size_t end = std::min(line.find(';'), line.size());
      if (const auto number =
              end > equals ? FieldNumber(Trimmed(line.substr(equals + 1, end - equals - 1)), false) : std::nullopt)
        track.numbers[word] = *number;
    }
  }
  recording.layout = fmt::format("the array {} in a program text, {} entries", found->name, found->value.size());
  track.columns.push_back(std::move(*found));
  track.columns[0].name = "entry";
  track.time_s.resize(track.columns[0].value.size());
  for (std::size_t i = 0; i < track.time_s.size(); ++i) track.time_s[i] = static_cast<double>(i);
  recording.tracks.push_back(std::move(track));
}

}  // namespace twinbench::imports
