#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <string>
#include <vector>

/// A function in clones for several processors is called by others through the one that suits the processor, or so
/// it should be: clang 14 gives the name that other sources see to the AVX-512 clone, whose instructions end a
/// program on a processor without them.
namespace {

struct Clone {
  std::string place, name;
  bool is_internal = false;
};

std::vector<std::filesystem::path> FilesThatEndIn(const std::string& extension) {
  std::vector<std::filesystem::path> files;
  for (const char* top : {"optics", "mechanics", "twin", "hw_bridge", "tools"})
    for (const auto& entry :
         std::filesystem::recursive_directory_iterator(std::filesystem::path(TWINBENCH_SOURCE_DIR) / top))
      if (entry.path().extension() == extension) files.push_back(entry.path());
  return files;
}

void AddClonesOf(const std::filesystem::path& source, std::vector<Clone>& clones) {
  const std::regex cloned(R"(target_clones\(.*\]\] \w+ (\w+)\()");
  std::ifstream in(source);
  std::smatch match;
  bool is_internal = false;
  int number = 0;
  for (std::string line; std::getline(in, line);) {
    ++number;
    if (line == "namespace {") is_internal = true;
    if (line == "}  // namespace") is_internal = false;
    if (std::regex_search(line, match, cloned))
      clones.push_back({source.string() + ":" + std::to_string(number), match[1], is_internal});
  }
}

std::string AllHeaders() {
  std::string text;
  for (const auto& header : FilesThatEndIn(".h")) {
    std::ifstream in(header);
    text.append(std::istreambuf_iterator<char>(in), {});
  }
  return text;
}

TEST(Clones, AreDeclaredForNoOtherSource) {
  std::vector<Clone> clones;
  for (const auto& source : FilesThatEndIn(".cc")) AddClonesOf(source, clones);
  EXPECT_GT(clones.size(), 10u) << "they are found";
  const std::string headers = AllHeaders();
  for (const Clone& clone : clones) {
    const bool is_declared = headers.find(" " + clone.name + "(") != std::string::npos;
    EXPECT_FALSE(is_declared && !clone.is_internal)
        << clone.place << ": call " << clone.name << " from a function without clones";
  }
}

}  // namespace
