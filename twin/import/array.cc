#include "twin/import/layouts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <iterator>
#include <numeric>
#include <optional>

#include "twin/core/errors.h"
#include "twin/core/lag.h"
#include "twin/import/column_words.h"
#include "twin/import/common.h"
#include "twin/import/layout.h"
#include "twin/import/table.h"
#include "twin/import/text.h"
#include "twin/import/unit_names.h"

namespace twinbench::imports {
namespace {

/// A line of MATLAB ("%") or Python ("#") that says something for people.
bool BeginsRemark(std::string_view text, std::size_t at) {
  if (text[at] != '%' && text[at] != '#') return false;
  return at == 0 || text[at - 1] == '\n' || text[at - 1] == ' ' || text[at - 1] == ';';
}

std::string WithoutComments(std::string_view text) {
  std::string code;
  code.reserve(text.size());
  for (std::size_t at = 0; at < text.size();) {
    if (text.substr(at, 2) == "/*") {
      at = std::min(text.find("*/", at + 2), text.size() - 2) + 2;
    } else if (text.substr(at, 2) == "//" || BeginsRemark(text, at)) {
      at = std::min(text.find('\n', at), text.size());
    } else {
      code += text[at++];
    }
  }
  return code;
}

/// What stands behind "//", as if it were code.
std::string CodeInComments(std::string_view text) {
  std::string code;
  Lines lines(text);
  for (std::string_view line; lines.Next(line);) {
    line = Trimmed(line);
    if (!line.starts_with("//")) continue;
    line.remove_prefix(std::min(line.find_first_not_of('/'), line.size()));
    code += std::string(line) + '\n';
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

/// 12, 1.5f, 4096u, 0x7F5E.
std::optional<double> EntryNumber(std::string_view field) {
  if (field.starts_with("0x") || field.starts_with("0X")) {
    field.remove_prefix(2);
    unsigned long number = 0;
    const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), number, 16);
    const bool whole = error == std::errc() && std::string_view(end, field.data() + field.size()).find_first_not_of("uUlL") == std::string_view::npos;
    return whole ? std::optional(static_cast<double>(number)) : std::nullopt;
  }
  while (!field.empty() && std::string_view("fFuUlL").find(field.back()) != std::string_view::npos) field.remove_suffix(1);
  return FieldNumber(field, false);
}

/// 0:10:180, as MATLAB counts; nothing of anything else.
std::vector<double> RangeIn(std::string_view field) {
  constexpr double kMost = 1e6;
  std::vector<double> parts;
  for (std::size_t at = 0; at <= field.size();) {
    const std::size_t end = std::min(field.find(':', at), field.size());
    const auto number = FieldNumber(field.substr(at, end - at), false);
    if (!number) return {};
    parts.push_back(*number);
    at = end + 1;
  }
  if (parts.size() == 2) parts.insert(parts.begin() + 1, 1.0);
  if (parts.size() != 3) return {};
  std::vector<double> numbers;
  const double steps = std::floor((parts[2] - parts[0]) / parts[1] + 1e-9);
  for (double k = 0.0; k <= steps && steps < kMost; ++k) numbers.push_back(parts[0] + k * parts[1]);
  return numbers;
}

/// @param others  Counts what is no number.
std::vector<double> NumbersIn(std::string_view list, std::size_t& others) {
  constexpr std::string_view kBetween = ", \t\r\n{}[]();";
  std::vector<double> numbers;
  for (std::size_t at = 0; (at = list.find_first_not_of(kBetween, at)) != std::string_view::npos;) {
    const std::size_t end = std::min(list.find_first_of(kBetween, at), list.size());
    const std::string_view field = list.substr(at, end - at);
    const std::vector<double> range = RangeIn(field);
    if (const auto number = EntryNumber(field)) {
      numbers.push_back(*number);
    } else if (field == "None" || field == "nan" || field == "NaN" || field == "np.nan") {
      numbers.push_back(kNaN);
    } else if (!range.empty()) {
      numbers.insert(numbers.end(), range.begin(), range.end());
    } else if (field != "...") {  // the line goes on
      ++others;
    }
    at = end;
  }
  return numbers;
}

/// What is declared before an equals sign: "float lookup[256]", "std::array<float, 256> lookup", or in Python "lookup".
std::string NameIn(std::string_view declared, char opening) {
  // A statement of Python ends with its line.
  if (const std::size_t line = declared.rfind('\n'); opening == '[' && line != std::string_view::npos) declared.remove_prefix(line + 1);
  const std::size_t open = declared.find('['), close = declared.rfind(']');
  if (open != std::string_view::npos && close != std::string_view::npos && open < close) return WordBefore(declared, open);
  const bool is_list = opening == '[' || declared.find("array<") != std::string_view::npos;
  return is_list && open == close ? WordBefore(declared, declared.size()) : "";
}

/// Behind an equals sign: the list's opening, perhaps in a call ("np.array(["); npos if there is none.
std::size_t Opening(std::string_view code, std::size_t at) {
  at = code.find_first_not_of(" \t\r\n", at);
  if (at == std::string_view::npos) return at;
  std::size_t called = at;
  while (called < code.size() && (IsLetter(code[called]) || code[called] == '.')) ++called;
  if (called < code.size() && code[called] == '(') at = code.find_first_not_of(" \t\r\n", called + 1);
  return at != std::string_view::npos && (code[at] == '{' || code[at] == '[') ? at : std::string_view::npos;
}

/// Behind the bracket that closes the one at `opening`.
std::size_t EndOfList(std::string_view code, std::size_t opening) {
  int depth = 0;
  for (std::size_t at = opening; at < code.size(); ++at) {
    if (code[at] == '{' || code[at] == '[') ++depth;
    if ((code[at] == '}' || code[at] == ']') && --depth == 0) return at;
  }
  return code.size();
}

/// {{0.0, -15}, {0.5, -11}, ...}: the columns of a list of rows of a few numbers each; none of anything else.
std::vector<Column> ColumnsOfRows(const std::string& name, std::string_view list) {
  constexpr std::size_t kFewestRows = 3, kMostColumns = 6;
  std::vector<Column> columns;
  for (std::size_t at = 0; (at = list.find_first_of("{[", at)) != std::string_view::npos;) {
    const std::size_t end = EndOfList(list, at);
    std::size_t others = 0;
    const std::vector<double> row = NumbersIn(list.substr(at + 1, end - at - 1), others);
    if (columns.empty()) columns.resize(row.size());
    if (others > 0 || row.size() != columns.size()) return {};
    for (std::size_t c = 0; c < row.size(); ++c) columns[c].value.push_back(row[c]);
    at = end;
  }
  const bool are_rows = columns.size() > 1 && columns.size() <= kMostColumns && columns.front().value.size() >= kFewestRows;
  for (std::size_t c = 0; c < columns.size(); ++c) columns[c].name = fmt::format("{}.{}", name, c);
  return are_rows ? columns : std::vector<Column>();
}

/// name[...] = { numbers }, name = [numbers]: every one in the text.
std::vector<Column> ArraysIn(std::string_view code) {
  std::vector<Column> arrays;
  for (std::size_t equals = 0; (equals = code.find('=', equals)) != std::string_view::npos; ++equals) {
    const std::size_t opening = Opening(code, equals + 1);
    if (opening == std::string_view::npos) continue;
    const std::size_t before = equals == 0 ? std::string_view::npos : code.find_last_of(";{}=", equals - 1);
    const std::size_t begin = before == std::string_view::npos ? 0 : before + 1;
    const std::string name = NameIn(code.substr(begin, equals - begin), code[opening]);
    if (const auto rows = ColumnsOfRows(name, code.substr(opening + 1, EndOfList(code, opening) - opening - 1)); !name.empty() && !rows.empty()) {
      arrays.insert(arrays.end(), rows.begin(), rows.end());
      continue;
    }
    const std::size_t end = std::min(code.find(code[opening] == '{' ? '}' : ']', opening), code.size());
    std::size_t others = 0;
    Column array{name, "", NumbersIn(code.substr(opening + 1, end - opening - 1), others), {}};
    if (!name.empty() && !array.value.empty()) arrays.push_back(std::move(array));
  }
  return arrays;
}

/// A text of numbers and nothing else is a list that lost its name.
void TakeBareList(std::string_view code, std::vector<Column>& arrays) {
  std::size_t others = 0;
  Column list{"list", "", NumbersIn(code, others), {}};
  if (others == 0 && !list.value.empty()) arrays.push_back(std::move(list));
}

/// Entry by entry on a line, whatever its slope.
bool AreOnALine(const Column& a, const Column& b) {
  constexpr double kLine = 0.98;
  return std::abs(LineThrough(a.value, b.value).correlation) > kLine;
}

/// Those as long as the longest that say together which is whose: the angles of a reference beside a device's, or two that lie on a line,
/// or the numbers of one list of rows. Of one name again, as for another machine, the first.
std::vector<Column> SideBySide(const std::vector<Column>& arrays) {
  std::vector<Column> beside;
  std::size_t rows = 0;
  for (const Column& array : arrays) rows = std::max(rows, array.value.size());
  for (const Column& array : arrays) {
    if (array.value.size() == rows && std::ranges::count(beside, array.name, &Column::name) == 0) beside.push_back(array);
  }
  const auto speak = [&beside](Speaks of) {
    return std::ranges::any_of(beside, [of](const Column& a) { return Clearness(a.name, of) > 0; });
  };
  const auto row_of = [](const Column& c) { return c.name.substr(0, c.name.find('.')); };
  const bool are_rows = beside.size() > 1 && row_of(beside[0]) == row_of(beside[1]);
  if (are_rows) std::erase_if(beside, [first = row_of(beside[0]), &row_of](const Column& c) { return row_of(c) != first; });
  const bool says_which =
      beside.size() > 1 && (are_rows || speak(Speaks::kReference) || (beside.size() == 2 && (speak(Speaks::kDevice) || AreOnALine(beside[0], beside[1]))));
  return says_which ? beside : std::vector<Column>();
}

/// A table that was put aside is longer than what is left.
void RefuseTablesInComments(std::string_view text, const std::vector<Column>& arrays, const std::string& file) {
  const auto longest = [](const std::vector<Column>& of) {
    std::size_t most = 0;
    for (const Column& array : of) most = std::max(most, array.value.size());
    return most;
  };
  const std::vector<Column> aside = ArraysIn(CodeInComments(text));
  const std::size_t most = longest(aside);
  if (most <= longest(arrays)) return;
  const auto count = std::ranges::count_if(aside, [most](const Column& a) { return a.value.size() == most; });
  throw InputError(file, fmt::format("{} of {} numbers {} in comments", count == 1 ? "an array" : fmt::format("{} arrays", count), most, count == 1 ? "stands" : "stand"),
                   "the one that is meant without its \"//\"");
}

/// `float zero = 1.2;`
void TakeNamedNumbers(std::string_view code, Track& track) {
  Lines lines(code);
  for (std::string_view line; lines.Next(line);) {
    const std::size_t equals = line.find('='), end = std::min(line.find(';'), line.size());
    if (equals == std::string_view::npos || line.find('{') != std::string_view::npos || end <= equals) continue;
    if (const auto number = FieldNumber(Trimmed(line.substr(equals + 1, end - equals - 1)), false)) track.numbers[WordBefore(line, equals)] = *number;
  }
}

void AddTrack(std::string_view code, const std::string& name, std::vector<Column> columns, Recording& recording) {
  Track track;
  track.name = name;
  track.columns = std::move(columns);
  TakeNamedNumbers(code, track);
  track.time_s.resize(track.columns.front().value.size());
  std::iota(track.time_s.begin(), track.time_s.end(), 0.0);
  recording.tracks.push_back(std::move(track));
}

/// What stands behind "lut = " or "lut = np.array(", as Python has it.
std::string_view BehindName(std::string_view line) {
  const std::size_t equals = line.find('=');
  if (equals == std::string_view::npos || !std::ranges::all_of(Trimmed(line.substr(0, equals)), IsLetter)) return line;
  const std::size_t opening = Opening(line, equals + 1);
  return opening == std::string_view::npos ? line : line.substr(opening);
}

}  // namespace

bool OpensList(std::string_view line) {
  constexpr std::size_t kFewest = 2;
  const std::size_t equals = line.find('='), opening = equals == std::string_view::npos ? equals : Opening(line, equals + 1);
  if (opening == std::string_view::npos || line[opening] != '[' || IsComment(line)) return false;
  std::size_t others = 0;
  const std::size_t end = std::min(line.find(']', opening), line.size());
  return !NameIn(line.substr(0, equals), '[').empty() && NumbersIn(line.substr(opening + 1, end - opening - 1), others).size() >= kFewest && others == 0;
}

bool IsBareList(const std::vector<std::string_view>& lines) {
  constexpr std::size_t kFewest = 12;
  std::size_t rows = 0, numbers = 0, most = 0, others = 0;
  for (const std::string_view line : lines) {
    if (IsComment(line)) continue;
    const std::size_t here = NumbersIn(rows == 0 ? BehindName(line) : line, others).size();
    if (here > 0) ++rows;
    numbers += here;
    most = std::max(most, here);
  }
  return others == 0 && numbers >= kFewest && (rows == 1 || most == 1);
}

void ReadArray(std::string_view text, const std::string& name, Recording& recording) {
  const std::string code = WithoutComments(text);
  std::vector<Column> arrays = ArraysIn(code);
  if (name.empty()) RefuseTablesInComments(text, arrays, recording.file);
  if (arrays.empty() && name.empty()) TakeBareList(code, arrays);
  if (std::vector<Column> beside = SideBySide(arrays); name.empty() && !beside.empty()) {
    recording.layout = fmt::format("{} arrays in a program text, {} entries each", beside.size(), beside.front().value.size());
    for (Column& column : beside) {
      const NameAndUnit split = SplitHeader(column.name);
      column.name = split.name;
      column.unit = split.unit;
    }
    return AddTrack(code, "arrays", std::move(beside), recording);
  }
  const auto found = name.empty()
                         ? std::ranges::max_element(arrays, {}, [](const Column& a) { return a.value.size(); })
                         : std::ranges::find(arrays, name, &Column::name);
  if (found == arrays.end())
    throw InputError(recording.file, name.empty() ? "no array of numbers" : "no array called " + name,
                     "name[...] = { numbers }, name = [numbers], or numbers and nothing else");
  recording.layout = fmt::format("the array {} in a program text, {} entries", found->name, found->value.size());
  if (found->name == "list") recording.layout = fmt::format("a list of {} numbers", found->value.size());
  if (arrays.size() > 1 && name.empty()) recording.remarks.push_back(fmt::format("{} further arrays are left out: array = a name under [file] of a map takes another", arrays.size() - 1));
  if (AreErrorsOf16Bit(found->value))
    recording.remarks.push_back("the entries are whole numbers about 32768: as errors, 32768 is none and 65536 is a turn");
  const std::string title = found->name;
  found->name = "entry";
  AddTrack(code, title, {std::move(*found)}, recording);
}

}  // namespace twinbench::imports
