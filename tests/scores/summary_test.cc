#include "tests/core/input_error.h"
#include "tests/scores/sets.h"
#include "tests/support/kept_text.h"

namespace twinbench::scores {
namespace {

using testing::HasSubstr;

Row Of(const std::string& name, const std::string& hidden, bool is_right) {
  Row row{"hidden", "rotary_4dof", name, hidden};
  row.marks[kRight] = is_right;
  row.marks[kSureWrong] = false;
  row.seconds = 2.0;
  return row;
}

// 2 of 5: Clopper-Pearson 5.3 to 85.3 %.
TEST(Summary, CountsBySetBenchAndEffectThoseClampedAtAnotherTimeApartAndListsWhatFallsShort) {
  Row sure = Of("2", "tone yaw", true);
  sure.marks[kSureWrong] = true;
  sure.answer = "named | [slip yaw 0.9]";
  EXPECT_KEPT(Summary({Of("1", "tone all", true), sure, Of("3", "tone yaw", false),
                       Of("clamped 4", "mount_creep yaw", false), Of("5", "mount_creep tilt", false)}));
}

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

TEST(CommittedScores, CanBeReadAndCoverEverySet) {
  const Rows rows = ReadRows(TWINBENCH_TEST_DATA "/scores/2026-12-01.csv");
  for (const char* set :
       {"hidden", "challenge", "foreign", "two_runs", "own_scenario", "investigate", "clean", "unlisted"})
    EXPECT_TRUE(std::ranges::any_of(rows, [&](const Row& row) { return row.set == set; })) << set;
}

using testing::ElementsAre, testing::IsEmpty;

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

TEST(Compare, TellsWhatWasLostAndWonOfEachMarkAndBenchANameThatIsNotThereAsALossWhereItComesUp) {
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
  Rows not_said, said;
  Add("a", 1, kSureWrong, false, not_said);
  Add("a", 1, kSureWrong, true, said);
  EXPECT_THAT(Compare(said, not_said).all[kSureWrong].lost, testing::SizeIs(1));
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
