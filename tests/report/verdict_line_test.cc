#include "twin/report/verdict_line.h"

#include <gtest/gtest.h>

#include "tests/diagnose/found_causes.h"

namespace twinbench::report {
namespace {

using diagnose::Cause;
using diagnose::Diagnosis;
using diagnose::Verdict;

Diagnosis Of(Verdict verdict, const std::vector<Cause>& causes) {
  Diagnosis d;
  d.verdict = verdict;
  d.causes = causes;
  d.readings = 720;
  return d;
}

Cause Backlash() {
  return diagnose::test::FoundCause("backlash", "", {"width", "deg", 1.0, 0.012, 3e-4, kNaN, kNaN});
}

Cause Without(const std::string& effect, double probability, const std::vector<std::string>& rivals) {
  Cause cause;
  cause.effect = effect;
  cause.probability = probability;
  for (const std::string& rival : rivals) cause.indistinguishable_from.push_back({rival, "", 1.0});
  return cause;
}

TEST(VerdictLine, NamesACauseWithItsFirstParameter) {
  EXPECT_EQ(VerdictLine(Of(Verdict::kNamed, {Backlash()}), "run.csv"),
            "Named: backlash, width 0.01200 +- 0.00030 deg (97 %) in 720 readings of run.csv");
}

TEST(VerdictLine, OfATieListsItsMembersOnce) {
  EXPECT_EQ(VerdictLine(Of(Verdict::kTie, {Without("a", 0.48, {"b"}), Without("b", 0.48, {"a"})}), "run.csv"),
            "Tie: a or b (48 % each) in 720 readings of run.csv");
  EXPECT_EQ(VerdictLine(Of(Verdict::kTie, {Without("a", 0.6, {"b", "c"}), Without("b", 0.3, {"a", "c"}),
                                           Without("c", 0.1, {"a", "b"}), Backlash()}),
                        "run.csv"),
            "Tie: a (60 %), b (30 %) or c (10 %); backlash, width 0.01200 +- 0.00030 deg (97 %) in run.csv");
}

TEST(VerdictLine, LeavesTheReadingsOutBeforeAName) {
  const std::string a(30, 'a'), b(30, 'b');
  EXPECT_EQ(VerdictLine(Of(Verdict::kTie, {Without(a, 0.48, {b}), Without(b, 0.48, {a})}), "run.csv"),
            "Tie: " + a + " or " + b + " (48 % each) in run.csv");
}

TEST(VerdictLine, SaysWhatIsUnknownOrThatNothingWasFound) {
  Diagnosis d = Of(Verdict::kUnknown, {});
  d.unknown.probability = 0.97;
  EXPECT_EQ(VerdictLine(d, "run.csv"),
            "Unknown: structure that no cause of the catalogue explains (97 %) in 720 readings of run.csv");
  d.verdict = Verdict::kNone;
  EXPECT_EQ(VerdictLine(d, "run.csv"), "Agrees: nothing found in 720 readings of run.csv");
  d.alarm_p = 0.4;
  EXPECT_EQ(VerdictLine(d, "a/rather/long/way/to/the/folder/"),
            "Agrees: nothing found in 720 readings of folder (p = 0.4)");
}

TEST(VerdictLine, IsOneLineHoweverManyCausesThereAre) {
  const std::string line = VerdictLine(Of(Verdict::kNamed, std::vector<Cause>(9, Backlash())), "run.csv");
  EXPECT_LE(line.size(), 98u);
  EXPECT_NE(line.find("; and "), std::string::npos) << line;
}

}  // namespace
}  // namespace twinbench::report
