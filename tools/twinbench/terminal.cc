#include "tools/twinbench/terminal.h"

#include <langinfo.h>
#include <locale.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <string_view>

namespace twinbench::tools {
namespace {

/// Asked of a locale of its own: numbers are read and written in that of C whatever the user's is.
bool IsUtf8Locale() {
  const locale_t users = newlocale(LC_CTYPE_MASK, "", nullptr);
  if (users == nullptr) return false;
  const bool is_utf8 = std::string_view(nl_langinfo_l(CODESET, users)) == "UTF-8";
  freelocale(users);
  return is_utf8;
}

std::string_view Terminal() {
  const char* const name = std::getenv("TERM");
  return name ? name : "dumb";
}

}  // namespace

bool MayColour(std::FILE* to) {
  const char* const unwanted = std::getenv("NO_COLOR");
  const bool is_unwanted = unwanted && *unwanted;
  return !is_unwanted && Terminal() != "dumb" && isatty(fileno(to)) != 0;
}

report::Letters LettersOfStdout() {
  const std::string_view terminal = Terminal();
  const bool has_fonts = terminal != "dumb" && terminal != "linux";
  const bool is_terminal = isatty(fileno(stdout)) != 0;
  return is_terminal && has_fonts && IsUtf8Locale() ? report::Letters::kUnicode : report::Letters::kAscii;
}

std::string ForTerminal(const std::string& text) {
  std::string clean;
  for (std::size_t k = 0; k < text.size(); ++k) {
    const auto c = static_cast<unsigned char>(text[k]);
    const auto next = static_cast<unsigned char>(k + 1 < text.size() ? text[k + 1] : 0);
    const bool is_c1 = c == 0xC2 && next >= 0x80 && next < 0xA0;  // U+0080 to U+009F in UTF-8
    const bool is_control = (c < 0x20 && c != '\n' && c != '\t') || c == 0x7F;
    if (is_c1) ++k;
    clean += is_c1 || is_control ? '?' : text[k];
  }
  return clean;
}

}  // namespace twinbench::tools
