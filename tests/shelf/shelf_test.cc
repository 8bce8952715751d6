#include "tests/core/input_error.h"
#include "tests/shelf/examine.h"
#include "tests/shelf/right_cases.h"

namespace twinbench::shelf {
namespace {

TEST(KnownCases, AreReadAsTheyAreWritten) {
  const std::string text = "05 right\n09 slow\n11 right slow\n";
  const KnownCases known = ParseKnownCases("# a comment\n\n" + text, "right.txt");
  EXPECT_EQ(known.at("05"), (Known{true, false}));
  EXPECT_EQ(known.at("09"), (Known{false, true}));
  EXPECT_EQ(known.at("11"), (Known{true, true}));
  EXPECT_EQ(InLines(known), text);
}

TEST(KnownCases, RefuseALineThatSaysSomethingElse) {
  EXPECT_NE(MessageOf([] { ParseKnownCases("05 right\n07 wrong\n", "right.txt"); }).find("right.txt:2"),
            std::string::npos);
}

// One test a recording, so that they can be run side by side and one by one.

class Shelf : public ::testing::TestWithParam<std::string> {};

/// A case that is about as slow as the limit is not to change its mark with every run.
bool IsSlow(double cpu_s, bool was_slow) { return cpu_s > (was_slow ? 2.0 : 3.0); }

TEST_P(Shelf, IsDiagnosedAsWellAsItWas) {
  const std::string name = GetParam();
  KnownCases known = ReadKnownCases();
  const char* const accept = std::getenv("TWINBENCH_ACCEPT_RIGHT");  // "1"; "all": of slow ones too
  if (known[name].is_slow && (!accept || accept != std::string("all"))) GTEST_SKIP() << "only tests/scores runs it";
  const Answer answer = Examine(name, false);
  if (accept) {
    known[name] = {answer.judged.is_right, IsSlow(answer.cpu_s, known[name].is_slow)};
    WriteKnownCases(known);
    return;
  }
  if (known[name].is_right)
    EXPECT_TRUE(answer.judged.is_right) << "was right: " << answer.judged.why << "\n" << answer.words;
  else
    EXPECT_FALSE(answer.judged.is_right) << "is right now: add this line to tests/data/shelf/right.txt\n"
                                         << name << " right";
}

INSTANTIATE_TEST_SUITE_P(Recordings, Shelf, ::testing::ValuesIn(CaseNames()),
                         [](const auto& one) { return one.param; });

}  // namespace
}  // namespace twinbench::shelf
