#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

/// A function in clones for several processors is called by others through the one that suits the processor, or so
/// it should be: clang 14 gives the name that other sources see to the AVX-512 clone, whose instructions end a
/// program on a processor without them.
namespace {

namespace fs = std::filesystem;

const fs::path kProject = TWINBENCH_SOURCE_DIR;

struct Clone {
  std::string place;
  bool is_internal = false;
};

void AddClonesOf(const fs::path& source, std::vector<Clone>& clones) {
  std::ifstream in(source);
  bool is_internal = false;
  int number = 0;
  for (std::string line; std::getline(in, line);) {
    ++number;
    if (line == "namespace {") is_internal = true;
    if (line == "}  // namespace") is_internal = false;
    if (line.find("target_clones(") != std::string::npos)
      clones.push_back({fs::relative(source, kProject).string() + ":" + std::to_string(number), is_internal});
  }
}

TEST(Clones, AreSeenByNoOtherSource) {
  std::vector<Clone> clones;
  for (const char* top : {"optics", "mechanics", "twin", "hw_bridge", "tools"})
    for (const auto& entry : fs::recursive_directory_iterator(kProject / top))
      if (entry.path().extension() == ".h" || entry.path().extension() == ".cc") AddClonesOf(entry.path(), clones);
  EXPECT_GT(clones.size(), 10u) << "they are found";
  for (const Clone& clone : clones)
    EXPECT_TRUE(clone.is_internal) << clone.place << ": call it from a function without clones";
}

}  // namespace
