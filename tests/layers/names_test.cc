#include <gtest/gtest.h>

#include <filesystem>
#include <regex>
#include <string>
#include <vector>

#include "tests/layers/source_files.h"

/// A bench's name stands in its own folder, scenarios, tests and docs: whatever else needs one is told it by a
/// scenario or a record.
namespace twinbench {
namespace {

/// The folders of the benches are called like the benches.
std::vector<std::string> BenchFolders() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(kProject / "twin/benches")) {
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

/// "file:line", of every line of code below `folders` that names a bench. What a line includes is a path and no
/// name.
std::vector<std::string> LinesThatNameABench(const std::vector<std::string>& folders) {
  const std::regex name = NameOfABench();
  std::vector<std::string> places;
  for (const std::string& file : FilesBelow(folders)) {
    int number = 0;
    for (const std::string& line : LinesOf(file)) {
      ++number;
      const bool may = line.find('"') != line.npos || line.find("Bench") != line.npos;  // a regex takes its time
      if (may && !line.starts_with("#include") && std::regex_search(line, name))
        places.push_back(file + ":" + std::to_string(number));
    }
  }
  return places;
}

TEST(BenchNames, StandNowhereButInTheBenchesFolders) {
  for (const std::string& line : LinesThatNameABench(kCodeFolders))
    EXPECT_TRUE(line.starts_with("twin/benches/")) << line << " names a bench";
}

TEST(BenchNames, AreFoundWhereTheyStand) {
  // Guards the test above against passing because nothing was read.
  EXPECT_GE(BenchFolders().size(), 4u);
  EXPECT_GE(LinesThatNameABench({"twin/benches"}).size(), BenchFolders().size());
}

}  // namespace
}  // namespace twinbench
