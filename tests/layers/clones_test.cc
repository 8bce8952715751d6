#include <gmock/gmock.h>

#include <regex>
#include <string>
#include <vector>

#include "tests/layers/source_files.h"

/// A function in clones for several processors is called by others through the one that suits the processor, or so
/// it should be: clang 14 gives the name that other sources see to the AVX-512 clone, whose instructions end a
/// program on a processor without them.
namespace twinbench {
namespace {

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

}  // namespace
}  // namespace twinbench
