#include "tests/tools/program_here.h"
#include "tools/web/bundle.h"

namespace twinbench::test {
namespace {

using ::testing::HasSubstr, ::testing::Not;

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
  Succeed({"score", "run", "--estimator", "published"});
  EXPECT_FALSE(Exists("run/score.json")) << "the page shows the other estimator's results";
  Succeed({"score", "run"});
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
  Write("other.json", "{\"a\": 1}");
  Write("notes.html", "three weeks of work");
  Write("deep.json", "{\"steps\":" + std::string(100'000, '[') + std::string(100'000, ']') + "}");
  Write("damaged.json", "{\"runs\": [1], \"advice\": [2]}");
  Succeed({"score", "run"});  // of a run that was not, a line more is said
  ExpectRefused({"report", "nothing"});
  ExpectRefused({"report", "other.json", "--svg", "p"}, "other.json: ");
  ExpectRefused({"report", "run", "-o", "run/results.json"});
  ExpectRefused({"report", "run", "-o", "notes.html"}, "notes.html: ");
  ExpectRefused({"report", "deep.json"}, "deep.json: ");
  EXPECT_THAT(Refusal({"report", "damaged.json"}),
              HasSubstr("damaged.json: a result in it is not as it is written"));
}

}  // namespace
}  // namespace twinbench::test
