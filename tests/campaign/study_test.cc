#include "tests/campaign/small_study.h"
#include "tests/core/input_error.h"
#include "tests/support/kept_text.h"
#include "twin/campaign/campaign.h"
#include "twin/campaign/study.h"
#include "twin/campaign/summary.h"
#include "twin/campaign/table.h"
#include "twin/core/reading.h"

namespace twinbench::campaign {
namespace {

using testing::StartsWith;

/// The first line of `lines` is line 12 of the study.
std::string Refusal(const std::string& lines) {
  return MessageOf([&] { ParseStudy(StudyOf(lines), "study.toml", ""); });
}

TEST(Study, RefusesWhatCannotBeAndSaysWhere) {
  const std::string vary = "[[vary]]\nkey = \"device.noise_deg\"\n", once = vary + "values = [0.1]\n";
  const std::pair<int, std::string> cases[] = {
      {12, "trails = 5\n"},
      {12, "trials = 2.5\n"},
      {13, "[[vary]]\nkey = \"device.noise_dag\"\nvalues = [0.1]\n"},
      {13, "[[vary]]\nkey = \"encoder_procedure.stops_per_turn\"\ndistribution = \"uniform\"\nlower = 20\nupper = 41\n"},
      {13, vary + "values = [0.1, -1]\n"},
      {12, vary + "distribution = \"normal\"\nmean = 1\n"},
      {17, vary + "distribution = \"normal\"\nmean = 1\nsd = 1\nupper = 3\n"},
      {13, "[[vary]]\nkey = \"seed\"\nvalues = [1, 2]\n"},
      {16, once + once},
      {12, "set = [\"titel=mine\"]\n"},
  };
  for (const auto& [line, lines] : cases) {
    EXPECT_THAT(Refusal(lines), StartsWith("study.toml:" + std::to_string(line) + ": "));
    EXPECT_KEPT(Refusal(lines));
  }
  EXPECT_KEPT(MessageOf([] { ParseStudy("trials = 3\n", "study.toml", ""); }));
}

TEST(Study, PutsItsFixedKeysIntoEveryTrial) {
  const Study study = ParseStudy(StudyOf("set = [\"title=mine\"]\n"), "study.toml", "");
  EXPECT_EQ(study.With({}).title, "mine");
  EXPECT_EQ(study.With({"title=another"}).title, "another");
}

// Whether the stated 95 % intervals hold the truth, on every bench: the studies of scenarios/studies/, fewer trials of them
// (docs/campaign.md has the figures of all), with the standards' errors drawn where that takes little time.

struct Covered {
  const char* study;
  int trials;
  std::vector<std::string> set;  // besides
  bool standards;
  std::vector<std::string> results;  // that the bench is built for
};

/// Numbers of one trial go together (one draw of a gain moves all), so that few trials leave a share that wanders by
/// several percent; what is wrong by a factor of 1.5 covers 81 %.
void ExpectCovered(const Covered& of) {
  SCOPED_TRACE(of.study);
  Study study = LoadStudy(TWINBENCH_SOURCE_DIR "/scenarios/studies/" + std::string(of.study));
  study.set.insert(study.set.end(), of.set.begin(), of.set.end());
  study.standards = of.standards;
  const Design design(study);
  Summary summary;
  for (int trial = 0; trial < of.trials; ++trial) summary.Add(RunTrial(study, design, trial));
  EXPECT_TRUE(summary.Lost().empty());
  const auto results = summary.Results();
  for (const std::string& name : of.results) {
    ASSERT_TRUE(results.contains(name)) << name;
    EXPECT_GT(results.at(name).coverage95, 0.87) << name;
    EXPECT_LT(results.at(name).coverage95, 0.995) << name;
  }
}

TEST(Coverage, OfEveryBenchIsThatOfTheStatedIntervals) {
  const Covered studies[] = {
      {"coverage_rotary.toml", 40, {}, true, {"score.target.ez_arcsec[]", "score.reference.dy_um[]"}},
      {"coverage_turntable.toml", 60, {}, true, {"score.turntable.ez_arcsec[]", "score.equation 5.ez_arcsec[]"}},
      {"coverage_hob.toml", 4, {}, true, {"score.transmission +1.amplitude_arcsec[]"}},
      {"coverage_circular.toml", 3, {"circular_procedure.points=24"}, false, {"score.path[].dx_um[]"}},
      {"coverage_freeform.toml", 3, {}, false, {"score.error_map.dx_um[]"}},
      {"coverage_encoder.toml", 40, {}, false, {"score.device.ez_arcsec[]"}}};
  for (const Covered& study : studies) ExpectCovered(study);
}

TEST(Summary, HasMeanScatterBiasAndCoverage) {
  Summary summary;
  // Values 9, 11, 13, 15 with u = 1 against the truth 10: errors -1, 1, 3, 5, of which two are within 1.96 u.
  for (int trial = 0; trial < 4; ++trial) {
    const double value = 9.0 + 2.0 * trial;
    summary.Add({trial, "", "", {{"a", value, 1.0, value - 10.0}}});
  }
  summary.Add({4, "no light", "", {}});
  const ResultSummary a = summary.Results().at("a");
  EXPECT_EQ(a.count, 4);
  // rms_error: root of (1 + 1 + 9 + 25) / 4
  for (const auto& [found, expected] : {std::pair(a.mean, 12.0),
                                        {a.sd, std::sqrt(20.0 / 3.0)},
                                        {a.rms_u, 1.0},
                                        {a.rms_error, 3.0},
                                        {a.bias, 2.0},
                                        {a.coverage95, 0.5}})
    EXPECT_DOUBLE_EQ(found, expected);
  ASSERT_EQ(summary.Lost().size(), 1u);
  EXPECT_EQ(summary.Lost()[0].trial, 4);
  ASSERT_EQ(summary.Worst(1).size(), 1u);
  EXPECT_EQ(summary.Worst(1)[0].trial, 3);
  EXPECT_DOUBLE_EQ(summary.Worst(1)[0].normed, 5.0);
}

/// An error of 2.5 u is inside the interval of 5 degrees of freedom (k = 2.57) and outside that of many.
TEST(Summary, CountsByTheCoverageFactorOfEachResult) {
  Summary summary;
  summary.Add({0, "", "", {{"few", 0.0, 1.0, 2.5, 2.57}, {"many", 0.0, 1.0, 2.5}}});
  EXPECT_DOUBLE_EQ(summary.Results().at("few").coverage95, 1.0);
  EXPECT_DOUBLE_EQ(summary.Results().at("many").coverage95, 0.0);
}

TEST(Summary, TakesTheNumbersOfAListTogetherEachAboutItsOwnMean) {
  Summary summary;
  const auto add = [&](int trial, double c0, double c1, double s0, double s1) {
    summary.Add({trial, "", "", {{"c[0]", c0, 1.0, kNaN}, {"c[1]", c1, 1.0, kNaN},
                                 {"s[0]", 0.0, 1.0, s0}, {"s[1]", 0.0, 1.0, s1}}});
  };
  add(0, 1.0, 101.0, 2.0, -4.0);
  add(1, 3.0, 103.0, 4.0, -2.0);
  const ResultSummary c = summary.Results().at("c[]");
  EXPECT_EQ(c.count, 4);
  EXPECT_DOUBLE_EQ(c.mean, 52.0);
  EXPECT_DOUBLE_EQ(c.sd, std::sqrt(2.0));  // each pair has 2 about its mean with one degree of freedom
  EXPECT_TRUE(std::isnan(c.coverage95));
  // Biases 3 and -3: they would cancel in a mean.
  EXPECT_DOUBLE_EQ(summary.Results().at("s[]").bias, 3.0);
}

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

TEST(Table, WhoseTrialsWereAlteredTakenAwayOrAddedIsRefused) {
  const TemporaryFolder folder;
  const Study study = ParseStudy(StudyOf("trials = 2\n"), "study.toml", "");
  const std::string path = folder.File("table.sqlite"), altered = folder.File("altered.sqlite");
  {
    Ranks alone(false);
    Table table = Table::Create(path, "1", study);
    RunCampaign(study, table, 1, alone, [](const CampaignProgress&) {});
  }
  EXPECT_EQ(std::ssize(Table::Open(path).Done()), 2);
  for (const char* change : {"UPDATE results SET value = value + 1e-9 WHERE trial = 1", "UPDATE trials SET seed = '7' WHERE trial = 0",
                             "DELETE FROM trials WHERE trial = 1; DELETE FROM results WHERE trial = 1",
                             "INSERT INTO results VALUES(2, 'x', 1.0, NULL, NULL, NULL)"}) {
    std::filesystem::copy_file(path, altered, std::filesystem::copy_options::overwrite_existing);
    SqliteDatabase(altered, SQLITE_OPEN_READWRITE).Execute(change);
    EXPECT_KEPT(MessageOf([&] { Table::Open(altered); }));
  }
}

}  // namespace
}  // namespace twinbench::campaign
