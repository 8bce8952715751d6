#pragma once

#include <sstream>
#include <vector>

namespace twinbench::report::test {

inline std::vector<std::string> LinesOf(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

}  // namespace twinbench::report::test
