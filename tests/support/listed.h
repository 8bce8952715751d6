#pragma once

#include <fstream>
#include <ranges>
#include <stdexcept>
#include <string>
#include <vector>

/// Tables of tests/data/lists.txt.
namespace twinbench::test {

/// What stands between the marks.
inline std::vector<std::string> Split(const std::string& text, const std::string& mark) {
  std::vector<std::string> parts;
  if (text.empty()) return parts;
  for (const auto part : std::views::split(text, mark)) parts.emplace_back(part.begin(), part.end());
  return parts;
}

/// The lines below "## name", each in its parts between " | ".
inline std::vector<std::vector<std::string>> Listed(const std::string& name) {
  std::vector<std::vector<std::string>> lines;
  std::ifstream file(TWINBENCH_TEST_DATA "/lists.txt");
  bool is_inside = false;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("#"))
      is_inside = line == "## " + name;
    else if (is_inside && !line.empty())
      lines.push_back(Split(line, " | "));
  }
  if (lines.empty()) throw std::runtime_error("no list " + name);
  return lines;
}

}  // namespace twinbench::test
