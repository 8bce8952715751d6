#include "twin/plan/mended.h"

namespace twinbench::plan {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

Outlook Losing(std::vector<std::string> lost) {
  Outlook outlook;
  outlook.lost = std::move(lost);
  outlook.separates = true;
  return outlook;
}

/// Half a turn leaves every second order of what one mounting does not separate at all, and says so in other words.
TEST(Mended, IsNothingOfWhichAPartStaysUnderAnotherName) {
  const Outlook own = Losing({"turntable and multi-tooth table"}), good = Losing({}), half_turn = Losing({"order 2", "order 4"});
  EXPECT_THAT(WhollyMendedBy(own, half_turn, good), IsEmpty());
  EXPECT_THAT(MendedInWords(own, half_turn), ElementsAre("turntable and multi-tooth table but for order 2; order 4"));
  EXPECT_THAT(WhollyMendedBy(own, Losing({}), good), ElementsAre("turntable and multi-tooth table"));
}

TEST(Mended, IsWhatIsWholeBesideAPartOfSomethingElse) {
  const Outlook own = Losing({"target dy", "reference dx"}), good = Losing({});
  EXPECT_THAT(WhollyMendedBy(own, Losing({"target dy orders 2, 4"}), good), ElementsAre("reference dx"));
  EXPECT_THAT(WhollyMendedBy(own, Losing({"target dy order 0"}), Losing({"target dy order 0"})), ElementsAre("target dy", "reference dx"))
      << "no shifts tell order 0";
  EXPECT_THAT(MendedInWords(own, Losing({"target dy order 0"})), ElementsAre("target dy but for order 0", "reference dx"));
}

TEST(Mended, IsOrder1WhereOrder12Stays) {
  const Outlook own = Losing({"device, order 1", "device, order 12"}), good = Losing({});
  EXPECT_THAT(WhollyMendedBy(own, Losing({"device, order 12"}), good), ElementsAre("device, order 1"));
}

}  // namespace
}  // namespace twinbench::plan
