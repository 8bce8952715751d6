#include "tests/shelf/right_cases.h"

#include <gtest/gtest.h>

#include "tests/core/input_error.h"

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

}  // namespace
}  // namespace twinbench::shelf
