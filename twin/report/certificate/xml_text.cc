#include "twin/report/certificate/xml_text.h"

#include <fmt/format.h>

namespace twinbench::certificate {

std::string XmlText(const std::string& text) {
  std::string clean = text;
  for (char& c : clean) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || byte == 0x7f) c = ' ';
  }
  const std::size_t from = clean.find_first_not_of(' ');
  if (from == std::string::npos) return "";
  clean = clean.substr(from, clean.find_last_not_of(' ') - from + 1);
  // U+FFFE and U+FFFF are no characters of XML.
  for (const char* none : {"\xEF\xBF\xBE", "\xEF\xBF\xBF"}) {
    for (std::size_t at = clean.find(none); at != std::string::npos; at = clean.find(none)) clean.replace(at, 3, "?");
  }
  return clean;
}

std::string XmlNumbers(const std::vector<double>& values) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "" : " ") + fmt::format("{}", value);
  return text;
}

}  // namespace twinbench::certificate
