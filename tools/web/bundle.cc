#include "tools/web/bundle.h"

#ifdef TWINBENCH_PAGE
// The assembler takes the files in as they are: a string literal of their size would cost the compiler seconds.
#define TWINBENCH_TAKE_IN(name, file)          \
  __asm__(".section .rodata\n" name "_begin:\n" \
          ".incbin \"" file "\"\n" name          \
          "_end:\n"                              \
          ".byte 0\n"                            \
          ".global " name "_begin\n"             \
          ".global " name "_end\n"               \
          ".text\n")
TWINBENCH_TAKE_IN("twinbench_page", TWINBENCH_PAGE);
TWINBENCH_TAKE_IN("twinbench_live", TWINBENCH_LIVE);
extern "C" const char twinbench_page_begin[], twinbench_page_end[], twinbench_live_begin[], twinbench_live_end[];
#endif

namespace twinbench::web {

std::string_view PageMarkup() {
#ifdef TWINBENCH_PAGE
  return {twinbench_page_begin, static_cast<std::size_t>(twinbench_page_end - twinbench_page_begin)};
#else
  return {};
#endif
}

std::string_view LiveMarkup() {
#ifdef TWINBENCH_PAGE
  return {twinbench_live_begin, static_cast<std::size_t>(twinbench_live_end - twinbench_live_begin)};
#else
  return {};
#endif
}

}  // namespace twinbench::web
