#include <gtest/gtest.h>

#include "tests/campaign/small_study.h"
#include "tests/core/input_error.h"
#include "tests/support/kept_text.h"
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

TEST(Table, HasOneWriterWhateverItIsCalledAndIsReadMeanwhile) {
  const TemporaryFolder folder;
  const Study study = ParseStudy(StudyOf("trials = 2\n"), "study.toml", "");
  const std::string path = folder.File("table.sqlite"), link = folder.File("link.sqlite");
  std::filesystem::create_symlink("table.sqlite", link);
  {
    const Table table = Table::Create(path, "1", study);
    for (const std::string& name : {path, link}) EXPECT_KEPT(MessageOf([&] { Table::Continue(name, "1", study); }));
    EXPECT_TRUE(Table::Open(path).Done().empty());
  }
  EXPECT_NO_THROW(Table::Continue(path, "1", study));
}

}  // namespace
}  // namespace twinbench::campaign
