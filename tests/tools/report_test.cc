#include <gmock/gmock.h>

#include "tests/tools/program_here.h"
#include "tools/web/bundle.h"

namespace twinbench::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class ReportCommand : public ProgramHere {
 protected:
  ReportCommand() {
    BeginWith("report", [this] {
      Write("small.toml", kSmall);
      MakeRun("run");
    });
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
  Succeed({"report", "run"});  // a page takes the place of a page
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
  Write("notes.html", "three weeks of work");
  EXPECT_THAT(Call({"report", "run", "-o", "notes.html"}).err, HasSubstr("notes.html: the file is there already"));
  EXPECT_EQ(Read("run/results.json"), results);
  Write("deep.json", "{\"steps\":" + std::string(100'000, '[') + std::string(100'000, ']') + "}");
  EXPECT_THAT(Call({"report", "deep.json"}).err, HasSubstr("deep.json: lists and objects in it are nested more than 100 deep"));
  Write("damaged.json", "{\"runs\": [1], \"advice\": [2]}");
  const Outcome damaged = Call({"report", "damaged.json"});
  EXPECT_EQ(damaged.exit_code, 2);
  EXPECT_THAT(damaged.err, HasSubstr("damaged.json: a result in it is not as it is written"));
}

}  // namespace
}  // namespace twinbench::test
