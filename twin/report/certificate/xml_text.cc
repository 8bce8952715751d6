#include "twin/report/certificate/xml_text.h"

#include <fmt/format.h>

namespace twinbench::certificate {

namespace {

/// Length of the UTF-8 sequence of a character of XML that begins at `at`; 0 if none does.
std::size_t CharacterAt(const std::string& text, std::size_t at) {
  const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U; };
  const unsigned first = byte(at);
  if (first < 0x80) return 1;
  const std::size_t length = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
  unsigned code = first & (0xffU >> (length + 1));
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(at + i) & 0xc0U) != 0x80U) return 0;
    code = code << 6 | (byte(at + i) & 0x3fU);
  }
  const unsigned smallest = length == 2 ? 0x80U : length == 3 ? 0x800U : 0x10000U;
  const bool is_none = code < smallest || code > 0x10ffff || (code >= 0xd800 && code < 0xe000) || code == 0xfffe || code == 0xffff;
  return first < 0xc0 || first >= 0xf8 || is_none ? 0 : length;
}

std::string OnlyCharacters(const std::string& text) {
  std::string clean;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = CharacterAt(text, at);
    clean += length == 0 ? "?" : text.substr(at, length);
    at += length == 0 ? 1 : length;
  }
  return clean;
}

}  // namespace

std::string XmlText(const std::string& text) {
  std::string clean = OnlyCharacters(text);
  for (char& c : clean) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || byte == 0x7f) c = ' ';
  }
  const std::size_t from = clean.find_first_not_of(' ');
  return from == std::string::npos ? "" : clean.substr(from, clean.find_last_not_of(' ') - from + 1);
}

std::string XmlNumbers(const std::vector<double>& values) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "" : " ") + fmt::format("{}", value);
  return text;
}

}  // namespace twinbench::certificate
