#include "tests/scores/compare.h"

#include <gmock/gmock.h>

namespace twinbench::scores {
namespace {

using testing::ElementsAre, testing::HasSubstr, testing::IsEmpty;

// Closed form: twice the tail of a binomial with one half. 2 (1 + 10) / 2^10, 2 / 2^6, 2 (1 + 5) / 2^5.
TEST(McNemar, IsTwiceTheBinomialTailAndOneIfNothingChangedOrAsMuchEitherWay) {
  EXPECT_NEAR(McNemar(1, 9), 22.0 / 1024.0, 1e-12);
  EXPECT_NEAR(McNemar(9, 1), 22.0 / 1024.0, 1e-12);
  EXPECT_NEAR(McNemar(0, 6), 2.0 / 64.0, 1e-12);
  EXPECT_NEAR(McNemar(1, 4), 12.0 / 32.0, 1e-12);
  for (const int either_way : {0, 3}) EXPECT_DOUBLE_EQ(McNemar(either_way, either_way), 1.0);
}

/// `count` cases of a bench with one mark.
void Add(const std::string& bench, int count, Mark mark, bool is_so, Rows& rows) {
  for (int k = 0; k < count; ++k) {
    Row row{"hidden", bench, std::to_string(rows.size()), "tone"};
    row.marks[mark] = is_so;
    rows.push_back(row);
  }
}

TEST(Compare, TellsWhatWasLostAndWonOfEachMarkAndBench) {
  Rows before, now;
  Add("a", 2, kRight, true, before);
  Add("b", 1, kRight, false, before);
  now = before;
  now[0].marks[kRight] = false;
  now[0].answer = "none";
  now[2].marks[kRight] = true;
  const Comparison c = Compare(now, before);
  EXPECT_THAT(c.all[kRight].lost, ElementsAre("hidden a 0: none"));
  EXPECT_THAT(c.all[kRight].won, ElementsAre("hidden b 2: "));
  EXPECT_THAT(c.of_bench.at(0).second[kRight].lost, testing::SizeIs(1));
  EXPECT_THAT(c.of_bench.at(0).second[kRight].won, IsEmpty());
  EXPECT_THAT(InWords(c), HasSubstr("right: right -> wrong\n  hidden a 0: none\n"));
}

TEST(Compare, CountsANameThatIsNotThereAsALossWhereItComesUp) {
  Rows before, now;
  Add("a", 1, kSureWrong, false, before);
  Add("a", 1, kSureWrong, true, now);
  EXPECT_THAT(Compare(now, before).all[kSureWrong].lost, testing::SizeIs(1));
}

TEST(Compare, LeavesOutWhatOnlyOneOfBothWasAskedAndCountsCasesThatOneLacks) {
  Rows before, now;
  Add("a", 3, kRight, true, before);
  Add("a", 2, kRight, false, now);
  Add("b", 4, kRight, false, now);
  now[1].marks[kRight].reset();
  const Comparison c = Compare(now, before);
  EXPECT_EQ(c.only_now, 4);
  EXPECT_EQ(c.only_before, 1);
  EXPECT_THAT(c.all[kRight].lost, testing::SizeIs(1));
}

// Six to none has p = 0.031, five to none 0.0625.
TEST(Compare, IsWorseOnlyWhereChanceWouldHardlyDoIt) {
  Rows before, five, six;
  Add("a", 6, kRight, true, before);
  Add("a", 5, kRight, false, five);
  Add("a", 6, kRight, false, six);
  EXPECT_FALSE(Compare(five, before).IsWorse());
  EXPECT_TRUE(Compare(six, before).IsWorse());
  EXPECT_FALSE(Compare(before, six).IsWorse());
}

}  // namespace
}  // namespace twinbench::scores
