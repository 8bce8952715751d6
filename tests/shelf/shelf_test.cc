#include "tests/hidden/known_wrong.h"
#include "tests/shelf/judge.h"

namespace twinbench::shelf {
namespace {

/// They take more than some 3 s of a processor: only tools/scores --set shelf runs them.
const std::set<std::string> kSlow = {"01", "02", "04", "09", "10", "11", "24", "25", "26",
                                     "27", "28", "33", "46"};

// One test a recording, so that they can be run side by side and one by one.

class Shelf : public ::testing::TestWithParam<std::string> {};

TEST_P(Shelf, IsDiagnosedRightlySaveForKnownCases) {
  const std::string& name = GetParam();
  if (kSlow.contains(name)) GTEST_SKIP() << "only tools/scores runs it";
  const Answer answer = Examine(name, false);
  std::vector<hidden::KnownWrong> known = hidden::KnownWrongCases();
  std::erase_if(known, [&name](const hidden::KnownWrong& one) { return one.name != name; });
  const std::string words = answer.judged.why + " <- " + answer.words;
  EXPECT_TRUE(hidden::WrongOnlyWhereKnown({{"shelf", name, answer.judged.is_right, words}}, known));
}

INSTANTIATE_TEST_SUITE_P(Recordings, Shelf, ::testing::ValuesIn(CaseNames()),
                         [](const auto& one) { return one.param; });

}  // namespace
}  // namespace twinbench::shelf
