#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace twinbench::hw {

/// ASCII only: what the protocols are made of.
std::string UpperCase(std::string_view text);

/// The parts of a line between separators; those within quotes do not count. Blanks around are dropped.
std::vector<std::string> SplitOutsideQuotes(std::string_view line, char separator);

/// The words between blanks.
std::vector<std::string> SplitWords(std::string_view line);

/// The first line of what a browser or another program of the web sends.
bool IsHttp(std::string_view line);

}  // namespace twinbench::hw
