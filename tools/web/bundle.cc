#include "tools/web/bundle.h"

#ifdef TWINBENCH_PAGE
// The assembler takes the file in as it is: a string literal of its size would cost the compiler seconds.
__asm__(
    ".section .rodata\n"
    "twinbench_page_begin:\n"
    ".incbin \"" TWINBENCH_PAGE
    "\"\n"
    "twinbench_page_end:\n"
    ".byte 0\n"
    ".global twinbench_page_begin\n"
    ".global twinbench_page_end\n"
    ".text\n");
extern "C" const char twinbench_page_begin[], twinbench_page_end[];
#endif

namespace twinbench::web {

std::string_view PageMarkup() {
#ifdef TWINBENCH_PAGE
  return {twinbench_page_begin, static_cast<std::size_t>(twinbench_page_end - twinbench_page_begin)};
#else
  return {};
#endif
}

}  // namespace twinbench::web
