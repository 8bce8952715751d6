#include "twin/import/text.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <utility>

#include "twin/core/errors.h"
#include "twin/core/input_text.h"

namespace twinbench::imports {
namespace {

constexpr std::array kSeparators = std::to_array<std::pair<char, const char*>>(
    {{'\t', "tab"}, {';', "semicolon"}, {',', "comma"}, {'|', "bar"}, {' ', "space"}});

void AppendUtf8(std::uint32_t code, std::string& text) {
  if (code < 0x80) {
    text += static_cast<char>(code);
  } else if (code < 0x800) {
    text += static_cast<char>(0xC0 | (code >> 6));
    text += static_cast<char>(0x80 | (code & 0x3F));
  } else {
    text += static_cast<char>(0xE0 | (code >> 12));
    text += static_cast<char>(0x80 | ((code >> 6) & 0x3F));
    text += static_cast<char>(0x80 | (code & 0x3F));
  }
}

/// Without surrogates: a table of measurements has none that matter.
std::string FromUtf16(std::string_view bytes, bool low_first) {
  std::string text;
  text.reserve(bytes.size() / 2);
  for (std::size_t i = 2; i + 1 < bytes.size(); i += 2) {
    const auto a = static_cast<unsigned char>(bytes[i]), b = static_cast<unsigned char>(bytes[i + 1]);
    AppendUtf8(low_first ? static_cast<std::uint32_t>(a | (b << 8)) : static_cast<std::uint32_t>((a << 8) | b),
               text);
  }
  return text;
}

/// Bytes of which every one above 127 begins or goes on with a character of UTF-8.
bool IsUtf8(std::string_view bytes) {
  int rest = 0;
  for (const char c : bytes) {
    const auto byte = static_cast<unsigned char>(c);
    const bool goes_on = (byte & 0xC0) == 0x80;
    if (goes_on != (rest > 0)) return false;
    if (rest > 0) {
      --rest;
    } else if (byte >= 0x80) {
      if (byte < 0xC2 || byte > 0xF4) return false;
      rest = byte >= 0xF0 ? 3 : byte >= 0xE0 ? 2 : 1;
    }
  }
  return rest == 0;
}

/// The Western code page of older programs: a byte a character.
std::string FromLatin1(std::string_view bytes) {
  std::string text;
  for (const char c : bytes) AppendUtf8(static_cast<unsigned char>(c), text);
  return text;
}

/// "1.234.567,8" or "1'234.5" without its marks of thousands: groups of three digits each before a decimal mark, which has to
/// be there, for "1.234" alone may be either.
std::optional<std::string> WithoutThousands(std::string_view field, char decimal) {
  const std::size_t point = field.find(decimal);
  if (point == std::string_view::npos) return std::nullopt;
  std::string plain;
  std::size_t digits = 0;
  bool grouped = false;
  for (std::size_t i = 0; i < point; ++i) {
    const char c = field[i];
    const bool mark = c == ' ' || c == '\'' || c == (decimal == ',' ? '.' : ',');
    if (mark && (digits == 0 || digits > 3 || (grouped && digits != 3))) return std::nullopt;
    if (mark) {
      grouped = true;
      digits = 0;
      continue;
    }
    if (std::isdigit(static_cast<unsigned char>(c))) ++digits;
    plain += c;
  }
  if (!grouped || digits != 3) return std::nullopt;
  return plain + std::string(field.substr(point));
}

std::optional<double> PlainNumber(std::string_view field, bool decimal_comma) {
  std::array<char, 64> plain;
  if (decimal_comma) {
    std::ranges::transform(field, plain.begin(), [](char c) { return c == ',' ? '.' : c == '.' ? '?' : c; });
    field = {plain.data(), field.size()};
  }
  double number = 0.0;
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), number);
  if (error != std::errc() || end != field.data() + field.size() || !std::isfinite(number)) return std::nullopt;
  return number;
}

void SplitAtBlanks(std::string_view line, std::vector<std::string_view>& fields) {
  for (std::size_t at = 0; (at = line.find_first_not_of(" \t", at)) != std::string_view::npos;) {
    const std::size_t end = std::min(line.find_first_of(" \t", at), line.size());
    fields.push_back(line.substr(at, end - at));
    at = end;
  }
}

std::string_view Unquoted(std::string_view field) {
  field = Trimmed(field);
  if (field.size() >= 2 && field.front() == field.back() && (field.front() == '"' || field.front() == '\''))
    return Trimmed(field.substr(1, field.size() - 2));
  return field;
}

/// Where the field that begins at `at` ends: a separator inside quotes is none.
std::size_t EndOfField(std::string_view line, std::size_t at, char separator) {
  const std::size_t first = line.find_first_not_of(" \t", at);
  if (first != std::string_view::npos && line[first] == '"' && separator != '"') {
    const std::size_t closed = line.find('"', first + 1);
    if (closed != std::string_view::npos) return std::min(line.find(separator, closed), line.size());
  }
  return std::min(line.find(separator, at), line.size());
}

}  // namespace

std::string LoadText(const std::string& path) {
  std::string bytes = InputText(path, "a readable text file");
  if (bytes.starts_with("\xFF\xFE")) return FromUtf16(bytes, true);
  if (bytes.starts_with("\xFE\xFF")) return FromUtf16(bytes, false);
  if (bytes.starts_with("\xEF\xBB\xBF")) bytes.erase(0, 3);
  if (bytes.substr(0, 4096).find('\0') != std::string::npos)
    throw InputError(path, "the file is binary", "a text file: export the recording as text or CSV");
  return IsUtf8(bytes) ? bytes : FromLatin1(bytes);
}

bool Lines::Next(std::string_view& line) {
  if (rest_.empty()) return false;
  const std::size_t end = rest_.find_first_of("\r\n");
  line = rest_.substr(0, end);
  std::size_t used = std::min(end, rest_.size());
  if (used < rest_.size()) used += rest_.substr(used).starts_with("\r\n") ? 2 : 1;
  rest_.remove_prefix(used);
  ++number_;
  return true;
}

std::string_view Trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

void Split(std::string_view line, char separator, std::vector<std::string_view>& fields) {
  fields.clear();
  if (separator == ' ') return SplitAtBlanks(line, fields);
  if (separator == '|') {  // a bar at either end is the table's frame
    line = Trimmed(line);
    if (line.starts_with('|')) line.remove_prefix(1);
    if (line.ends_with('|')) line.remove_suffix(1);
  }
  for (std::size_t at = 0;; ++at) {
    const std::size_t end = EndOfField(line, at, separator);
    fields.push_back(Unquoted(line.substr(at, end - at)));
    at = end;
    if (at >= line.size()) return;
  }
}

std::optional<double> FieldNumber(std::string_view field, bool decimal_comma) {
  constexpr std::string_view kMinus = "\xE2\x88\x92";  // as word processors print it
  if (!field.empty() && field.front() == '+') field.remove_prefix(1);
  if (field.empty() || field.size() > 60) return std::nullopt;
  if (field.starts_with(kMinus)) return FieldNumber("-" + std::string(field.substr(kMinus.size())), decimal_comma);
  if (const auto number = PlainNumber(field, decimal_comma)) return number;
  if (!std::isdigit(static_cast<unsigned char>(field.front())) && field.front() != '-') return std::nullopt;
  const auto plain = WithoutThousands(field, decimal_comma ? ',' : '.');
  return plain ? PlainNumber(*plain, decimal_comma) : std::nullopt;
}

std::string SeparatorName(char separator) {
  const auto found = std::ranges::find(kSeparators, separator, &std::pair<char, const char*>::first);
  return found == kSeparators.end() ? "" : found->second;
}

char SeparatorNamed(const std::string& name) {
  const auto found = std::ranges::find_if(kSeparators, [&name](const auto& known) { return name == known.second; });
  return found == kSeparators.end() ? '\0' : found->first;
}

}  // namespace twinbench::imports
