#pragma once

#include <cstdio>
#include <string>

#include "twin/report/curve_text.h"

namespace twinbench::tools {

/// What stdout can show: Unicode on a terminal whose locale is UTF-8 and that has the fonts for it (not the Linux
/// console, not a dumb one); ASCII else, as into a file or a pipe.
report::Letters LettersOfStdout();

/// Whether what is written to `to` may be coloured: it is a terminal, not a dumb one, and nobody has set NO_COLOR to anything (no-color.org).
bool MayColour(std::FILE* to);

/// Text that a device or a file may have written, with nothing in it that a terminal obeys: control characters but
/// line ends and tabs become question marks.
std::string ForTerminal(const std::string& text);

}  // namespace twinbench::tools
