#include <gmock/gmock.h>

#include <map>
#include <regex>
#include <set>
#include <string>

#include "tests/layers/source_files.h"

/// What two headers define inline by one name in one namespace is one thing to the linker, which takes either: no compiler says so, and it
/// goes well as long as both are inlined.
namespace twinbench {
namespace {

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

}  // namespace
}  // namespace twinbench
