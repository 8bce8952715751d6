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

}  // namespace

report::Letters LettersOfStdout() {
  const char* const name = std::getenv("TERM");
  const std::string_view terminal = name ? name : "dumb";
  const bool has_fonts = terminal != "dumb" && terminal != "linux";
  const bool is_terminal = isatty(fileno(stdout)) != 0;
  return is_terminal && has_fonts && IsUtf8Locale() ? report::Letters::kUnicode : report::Letters::kAscii;
}

}  // namespace twinbench::tools
