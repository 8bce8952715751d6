#include <gmock/gmock.h>

#include "tests/tools/program.h"
#include "tools/web/bundle.h"

namespace twinbench::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class ReportCommand : public Program {
 protected:
  ReportCommand() {
    Write("small.toml", kSmall);
    MakeRun("run");
  }
};

TEST_F(ReportCommand, WritesPicturesWithoutABrowserAndTruthOnlyOfAScoredRun) {
  Succeed({"report", "run", "--svg", "pictures"});
  EXPECT_THAT(Read("pictures/errors-target-ez.svg"), Not(HasSubstr("truth")));
  Succeed({"score", "run", "--json", "run/score.json"});
  Succeed({"report", "run", "--svg", "pictures"});
  EXPECT_THAT(Read("pictures/errors-target-ez.svg"), HasSubstr("truth"));
  EXPECT_FALSE(Exists("run/report.html"));
}

TEST_F(ReportCommand, IsOneFileThatNamesNoOther) {
  if (web::PageMarkup().empty()) GTEST_SKIP() << "built without pages";
  EXPECT_THAT(Succeed({"report", "run"}), HasSubstr("run/report.html"));
  const std::string page = Read("run/report.html");
  EXPECT_LT(page.size(), 3'000'000u);
  for (const char* other : {"<script src", "<link", "@import"}) EXPECT_EQ(page.find(other), std::string::npos) << other;
  EXPECT_NE(page.find("default-src 'none'; script-src 'sha256-"), std::string::npos);
}

TEST_F(ReportCommand, RefusesWhatNoPageIsMadeOfAndOverwritesNoInput) {
  EXPECT_EQ(Call({"report", "nothing"}).exit_code, 2);
  Write("other.json", "{\"a\": 1}");
  const Outcome other = Call({"report", "other.json", "--svg", "p"});
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_THAT(other.err, HasSubstr("other.json: there is nothing in it that a page is made of"));
  const std::string results = Read("run/results.json");
  EXPECT_EQ(Call({"report", "run", "-o", "run/results.json"}).exit_code, 2);
  EXPECT_EQ(Read("run/results.json"), results);
}

}  // namespace
}  // namespace twinbench::test
