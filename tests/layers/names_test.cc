#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>
#include <string>
#include <vector>

/// A bench's name stands in its own folder, scenarios, tests and docs: whatever else needs one is told it by a
/// scenario or a record.
namespace {

namespace fs = std::filesystem;

const fs::path kRoot = TWINBENCH_SOURCE_DIR;

/// The folders of the benches are called like the benches.
std::vector<std::string> BenchFolders() {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(kRoot / "twin/benches")) {
    if (entry.is_directory()) names.push_back(entry.path().filename());
  }
  return names;
}

/// A name in quotes, or one of the constants of twin/benches/names.h.
std::regex NameOfABench() {
  std::string names;
  for (const std::string& name : BenchFolders()) names += (names.empty() ? "" : "|") + name;
  return std::regex("\"(" + names + ")\"|\\bk(Rotary|Encoder|Turntable|Hob|Circular|Freeform)Bench\\b");
}

bool IsSource(const fs::path& path) {
  return path.extension() == ".h" || path.extension() == ".cc";
}

/// "file:line", of every line of code that names a bench. What a line includes is a path and no name.
std::vector<std::string> LinesThatNameABench(const fs::path& folder) {
  const std::regex name = NameOfABench();
  std::vector<std::string> lines;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (!IsSource(entry.path())) continue;
    std::ifstream in(entry.path());
    int number = 0;
    for (std::string line; std::getline(in, line);) {
      ++number;
      if (!line.starts_with("#include") && std::regex_search(line, name))
        lines.push_back(fs::relative(entry.path(), kRoot).string() + ":" + std::to_string(number));
    }
  }
  return lines;
}

TEST(BenchNames, StandNowhereButInTheBenchesFolders) {
  for (const char* top : {"optics", "mechanics", "twin", "hw_bridge", "tools"}) {
    for (const std::string& line : LinesThatNameABench(kRoot / top))
      EXPECT_TRUE(line.starts_with("twin/benches/")) << line << " names a bench";
  }
}

TEST(BenchNames, AreFoundWhereTheyStand) {
  // Guards the test above against passing because nothing was read.
  EXPECT_GE(BenchFolders().size(), 4u);
  EXPECT_GE(LinesThatNameABench(kRoot / "twin/benches").size(), BenchFolders().size());
}

}  // namespace
