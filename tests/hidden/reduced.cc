#include "tests/hidden/reduced.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>

#include "tests/hidden/score_table.h"

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

std::vector<Outcome> RunReduced(const std::vector<Plan>& plans) {
  return RunCases(plans, {1, CacheFolder(), {}});
}

int CountOf(const std::vector<Outcome>& outcomes, bool (*test)(const Outcome&)) {
  return static_cast<int>(std::ranges::count_if(outcomes, test));
}

::testing::AssertionResult IsNotBelow(int count, std::size_t of, double rate) {
  const double chance = ProbabilityOfAtMost(count, static_cast<int>(of), rate);
  if (of > 0 && chance > 0.01) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << count << " of " << of << ", and at a rate of " << rate
                                       << " so few have a probability of " << chance;
}

::testing::AssertionResult IsNotAbove(int count, std::size_t of, double rate) {
  return IsNotBelow(static_cast<int>(of) - count, of, 1.0 - rate);
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
