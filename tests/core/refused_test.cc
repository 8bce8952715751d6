#include <gmock/gmock.h>

#include "tests/core/refusals.h"
#include "twin/core/errors.h"
#include "twin/core/scenario.h"

namespace twinbench {
namespace {

/// One scenario of tests/data/refused_scenarios.txt.
struct RefusedScenario {
  std::string checked, place, text;
};

std::vector<RefusedScenario> RefusedScenarios() {
  std::vector<RefusedScenario> all;
  std::ifstream file(TWINBENCH_TEST_DATA "/refused_scenarios.txt");
  std::string checked;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("## "))
      checked = line.substr(3);
    else if (line.starts_with("=>"))
      all.push_back({checked, "s.toml:" + (line.size() > 3 ? line.substr(3) + ": " : ""), ""});
    else if (!checked.empty() && !all.empty())
      all.back().text += line + "\n";
  }
  return all;
}

TEST(RefusedScenario, IsToldByPlaceFaultAndWhatWasExpected) {
  const std::vector<RefusedScenario> all = RefusedScenarios();
  EXPECT_GE(all.size(), 114u);
  for (const RefusedScenario& one : all) {
    const std::string message = MessageOf([&] { ParseScenario(one.text, "s.toml", "."); });
    EXPECT_THAT(message, testing::StartsWith(one.place)) << one.checked << "\n" << one.text;
    EXPECT_KEPT(message) << one.checked << "\n" << one.text;
  }
}

}  // namespace
}  // namespace twinbench
