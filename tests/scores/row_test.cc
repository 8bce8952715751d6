#include "tests/scores/row.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>

#include "tests/core/input_error.h"

namespace twinbench::scores {
namespace {

Row Example() {
  Row row{"hidden", "rotary_4dof", "rotary:tone:all:9", "tone all, loud"};
  row.marks[kRight] = true;
  row.marks[kSecondSilent] = false;
  row.answer = "named [tone all 0.97]: \"hum\", 50 Hz";
  row.seconds = 1.25;
  return row;
}

TEST(Rows, ComeBackFromTheirFile) {
  const Rows back = ParseRows(Csv({Example()}), "f.csv");
  ASSERT_EQ(back.size(), 1u);
  EXPECT_EQ(back[0].Key(), Example().Key());
  EXPECT_EQ(back[0].hidden, "tone all, loud");
  EXPECT_EQ(back[0].marks, Example().marks);
  EXPECT_EQ(back[0].answer, "named [tone all 0.97]: 'hum', 50 Hz");
  EXPECT_DOUBLE_EQ(back[0].seconds, 1.25);
}

TEST(Rows, AreRefusedWithTheirLine) {
  const std::string good = Csv({Example()});
  const auto refusal = [](const std::string& text) { return MessageOf([&] { ParseRows(text, "f.csv"); }); };
  EXPECT_THAT(refusal(""), testing::StartsWith("f.csv:1"));
  EXPECT_THAT(refusal(good + "hidden,rotary_4dof,x\n"), testing::StartsWith("f.csv:3"));
  EXPECT_THAT(refusal(good + good.substr(good.find('\n') + 1)), testing::StartsWith("f.csv:3"));
  std::string other_mark = good;
  other_mark.replace(other_mark.find(",1,"), 3, ",2,");
  EXPECT_THAT(refusal(other_mark), testing::StartsWith("f.csv:2"));
  EXPECT_THROW(ReadRows("/no/such/file.csv"), InputError);
}

TEST(Rows, ReplaceAFileAsAWhole) {
  const TemporaryFolder folder;
  const std::string path = folder.File("scores.csv");
  WriteWhole(path, "old");
  WriteWhole(path, Csv({Example()}));
  EXPECT_EQ(ReadRows(path).size(), 1u);
  EXPECT_FALSE(std::filesystem::exists(path + ".part"));
  EXPECT_THROW(WriteWhole(folder.File("no/such/folder.csv"), "x"), InputError);
}

TEST(CommittedScores, CanBeReadAndCoverEverySet) {
  const Rows rows = ReadRows(TWINBENCH_TEST_DATA "/scores/2026-11-27.csv");
  for (const char* set :
       {"hidden", "challenge", "foreign", "two_runs", "own_scenario", "investigate", "clean", "unlisted"})
    EXPECT_TRUE(std::ranges::any_of(rows, [&](const Row& row) { return row.set == set; })) << set;
}

}  // namespace
}  // namespace twinbench::scores
