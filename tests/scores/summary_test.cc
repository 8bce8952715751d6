#include "tests/scores/summary.h"

#include <gmock/gmock.h>

namespace twinbench::scores {
namespace {

using testing::HasSubstr, testing::Not;

Row Of(const std::string& name, const std::string& hidden, bool is_right) {
  Row row{"hidden", "rotary_4dof", name, hidden};
  row.marks[kRight] = is_right;
  row.marks[kSureWrong] = false;
  row.seconds = 2.0;
  return row;
}

// 1 of 2: Clopper-Pearson 1.3 to 98.7 %.
TEST(Summary, CountsBySetAndBenchWithAnInterval) {
  EXPECT_THAT(Summary({Of("1", "tone all", true), Of("2", "tone yaw", false)}),
              HasSubstr("| hidden | rotary_4dof | 1/2: 1 to 99 % | 0/2 |  |  |  | 4 |"));
}

TEST(Summary, TellsHowManyOfEachEffectAreFoundAndSetsThoseApartThatAreClampedAtAnotherTime) {
  const std::string text = Summary({Of("1", "tone all", true), Of("2", "tone yaw", false),
                                    Of("clamped 3", "mount_creep yaw", false), Of("4", "mount_creep tilt", true)});
  EXPECT_THAT(text, HasSubstr("mount_creep 1/1, mount_creep (clamped at another time) 0/1, tone 1/2"));
}

TEST(Summary, ListsWhatFallsShort) {
  Row wrong = Of("2", "tone yaw", true);
  wrong.marks[kSureWrong] = true;
  wrong.answer = "named | [slip yaw 0.9]";
  const std::string text = Summary({Of("1", "tone all", true), wrong});
  EXPECT_THAT(text, HasSubstr("| hidden rotary_4dof | 2 | tone yaw | sure and wrong | named / [slip yaw 0.9] |"));
  EXPECT_THAT(text, Not(HasSubstr("| 1 | tone all")));
}

}  // namespace
}  // namespace twinbench::scores
