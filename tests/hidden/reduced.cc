#include "tests/hidden/reduced.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>

namespace twinbench::hidden {
namespace {

namespace fs = std::filesystem;

class Cache : public ::testing::Environment {
 public:
  static std::string Path() { return fs::temp_directory_path() / fmt::format("twinbench-hidden-{}", ::getpid()); }
  void SetUp() override { fs::create_directories(Path()); }
  void TearDown() override { fs::remove_all(Path()); }
};

::testing::Environment* const kCache = ::testing::AddGlobalTestEnvironment(new Cache);

}  // namespace

const std::string& CacheFolder() {
  static const std::string path = Cache::Path();
  return path;
}

std::vector<Outcome> RunReduced(const std::vector<Plan>& plans, int threads) {
  return RunCases(plans, {threads, CacheFolder()});
}

int CountOf(const std::vector<Outcome>& outcomes, bool (*test)(const Outcome&)) {
  return static_cast<int>(std::ranges::count_if(outcomes, test));
}

std::string Others(const std::vector<Outcome>& outcomes, bool (*right)(const Outcome&)) {
  std::string text;
  for (const Outcome& o : outcomes) {
    if (right(o)) continue;
    text += fmt::format("\n  {} {} hides {} (rho {:.0f}): {}", o.set, o.name, InWords(o.hidden), o.hidden.rho,
                        o.answer);
  }
  return text;
}

}  // namespace twinbench::hidden
