#include <regex>

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

TEST(BenchNames, StandInTheBenchesFoldersAndNowhereElse) {
  EXPECT_GE(BenchFolders().size(), 4u);
  EXPECT_GE(LinesThatNameABench({"twin/benches"}).size(), BenchFolders().size()) << "nothing was read";
  for (const std::string& line : LinesThatNameABench(kCodeFolders))
    EXPECT_TRUE(line.starts_with("twin/benches/")) << line << " names a bench";
}

// A function in clones for several processors is called by others through the one that suits the processor, or so
// it should be: clang 14 gives the name that other sources see to the AVX-512 clone, whose instructions end a
// program on a processor without them.

struct Clone {
  std::string place, name;
  bool is_internal = false;
};

void AddClonesOf(const std::string& source, std::vector<Clone>& clones) {
  const std::regex cloned(R"(target_clones\(.*\]\] \w+ (\w+)\()");
  std::smatch match;
  bool is_internal = false;
  int number = 0;
  for (const std::string& line : LinesOf(source)) {
    ++number;
    if (line == "namespace {") is_internal = true;
    if (line == "}  // namespace") is_internal = false;
    if (line.find("target_clones") != line.npos && std::regex_search(line, match, cloned))
      clones.push_back({source + ":" + std::to_string(number), match[1], is_internal});
  }
}

std::string AllHeaders() {
  std::string text;
  for (const std::string& header : FilesBelow(kCodeFolders, {".h"})) text += TextOf(header);
  return text;
}

TEST(Clones, AreDeclaredForNoOtherSource) {
  std::vector<Clone> clones;
  for (const std::string& source : FilesBelow(kCodeFolders, {".cc"})) AddClonesOf(source, clones);
  EXPECT_GT(clones.size(), 10u) << "they are found";
  const std::string headers = AllHeaders();
  for (const Clone& clone : clones) {
    const bool is_declared = headers.find(" " + clone.name + "(") != std::string::npos;
    EXPECT_FALSE(is_declared && !clone.is_internal)
        << clone.place << ": call " << clone.name << " from a function without clones";
  }
}

// What two headers define inline by one name in one namespace is one thing to the linker, which takes either: no compiler says so, and it
// goes well as long as both are inlined.

/// "twinbench::sim RotaryTableStack(const Scenario& actual)" and the headers that define it. Of a variable the type does not count.
std::map<std::string, std::set<std::string>> DefinitionsInHeaders() {
  const std::regex opens(R"(^namespace ([\w:]+) \{)"), function(R"(^inline [^=(]*?(\w+\([^)]*\)?))"),
      variable(R"(^inline constexpr [^=({]*?(\w+)(\[\w*\])? ?[={])");
  std::map<std::string, std::set<std::string>> found;
  for (const std::string& header : FilesBelow(kCodeFolders, {".h"})) {
    std::string space;
    std::smatch match;
    for (const std::string& line : LinesOf(header)) {
      if (!line.starts_with("inline ") && !line.starts_with("namespace ")) continue;
      if (std::regex_search(line, match, opens)) space = match[1];
      if (std::regex_search(line, match, variable) || std::regex_search(line, match, function))
        found[space + " " + match[1].str()].insert(header);
    }
  }
  return found;
}

TEST(OneDefinition, OfEveryNameThatHeadersDefineInline) {
  const auto definitions = DefinitionsInHeaders();
  EXPECT_GT(definitions.size(), 100u) << "they are found";
  for (const auto& [name, headers] : definitions) EXPECT_EQ(headers.size(), 1u) << name << testing::PrintToString(headers);
}

// Texts that are kept (tests/support/kept_text.h) go with the test that asks for them.

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
