#include <gtest/gtest.h>

#include <regex>
#include <set>
#include <string>

#include "tests/layers/source_files.h"

/// Texts that are kept (tests/support/kept_text.h) go with the test that asks for them.
namespace twinbench {
namespace {

/// "Suite.Test" of every test below tests/.
std::set<std::string> AllTests() {
  const std::regex begins(R"(^(?:TYPED_)?TEST(?:_F|_P)?\(\s*(\w+),\s*(\w+)\))");
  std::set<std::string> tests;
  for (const std::string& file : FilesBelow({"tests"})) {
    const std::vector<std::string> lines = LinesOf(file);
    for (std::size_t k = 0; k < lines.size(); ++k) {
      if (!lines[k].starts_with("TEST") && !lines[k].starts_with("TYPED_TEST")) continue;
      const std::string two = lines[k] + (k + 1 < lines.size() ? lines[k + 1] : "");
      if (std::smatch match; std::regex_search(two, match, begins))
        tests.insert(match[1].str() + "." + match[2].str());
    }
  }
  return tests;
}

/// "Instance/Suite.Test/parameter" and "Suite/type.Test" without what is no name in a source.
std::string InSource(const std::string& test) {
  static const std::regex said(R"((?:[A-Za-z]\w*/)?([A-Za-z]\w*)(?:/\d+)?\.(\w+)(?:/.*)?)");
  return std::regex_replace(test, said, "$1.$2");
}

TEST(KeptTexts, AreOfTestsThatThereAre) {
  EXPECT_EQ(InSource("Every/Bench.Says/rotary"), "Bench.Says");
  EXPECT_EQ(InSource("Bench/0.Says"), "Bench.Says");
  const std::set<std::string> tests = AllTests();
  EXPECT_TRUE(tests.contains("KeptTexts.AreOfTestsThatThereAre"));
  for (const std::string& line : LinesOf("tests/data/texts.txt")) {
    if (!line.starts_with("= ")) continue;
    EXPECT_TRUE(tests.contains(InSource(line.substr(2)))) << line << ": take its texts out of tests/data/texts.txt";
  }
}

}  // namespace
}  // namespace twinbench
