#include <gtest/gtest.h>

#include "tests/campaign/small_study.h"
#include "tests/core/input_error.h"
#include "twin/campaign/campaign.h"

namespace twinbench::campaign {
namespace {

TEST(RunCampaign, ThatIsStoppedKeepsWhatHasBegunAndGoesOnToTheSameTable) {
  const TemporaryFolder folder;
  const Study study = ParseStudy(StudyOf("trials = 20\n"), "study.toml", "");
  Ranks alone(false);
  Table whole = Table::Create(folder.File("whole.sqlite"), "1", study);
  EXPECT_TRUE(RunCampaign(study, whole, 2, alone, [](const CampaignProgress&) {}));

  Table table = Table::Create(folder.File("stopped.sqlite"), "1", study);
  std::int64_t kept = 0;
  const auto count = [&](const CampaignProgress& p) {
    EXPECT_EQ(p.done, ++kept);
    EXPECT_EQ(p.planned, 20);
    EXPECT_TRUE(p.row->failure.empty());
  };
  EXPECT_FALSE(RunCampaign(study, table, 2, alone, count, [&] { return kept >= 5; }));
  EXPECT_EQ(std::ssize(table.Done()), kept);
  EXPECT_GE(kept, 5);
  EXPECT_LT(kept, 20);
  EXPECT_TRUE(RunCampaign(study, table, 2, alone, [](const CampaignProgress&) {}));
  EXPECT_EQ(table.Csv(), whole.Csv());
}

}  // namespace
}  // namespace twinbench::campaign
