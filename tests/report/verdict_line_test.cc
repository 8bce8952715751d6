#include "twin/report/verdict_line.h"

#include <gtest/gtest.h>

#include "tests/diagnose/found_causes.h"
#include "tests/support/kept_text.h"

namespace twinbench::report {
namespace {

using diagnose::Cause, diagnose::Diagnosis, diagnose::Verdict;

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
  EXPECT_KEPT(VerdictLine(Of(Verdict::kNamed, {Backlash()}), "run.csv"));
}

TEST(VerdictLine, OfATieListsItsMembersOnceAndLeavesTheReadingsOutBeforeAName) {
  EXPECT_KEPT(VerdictLine(Of(Verdict::kTie, {Without("a", 0.48, {"b"}), Without("b", 0.48, {"a"})}), "run.csv"));
  const std::vector<Cause> three = {Without("a", 0.6, {"b", "c"}), Without("b", 0.3, {"a", "c"}),
                                    Without("c", 0.1, {"a", "b"}), Backlash()};
  EXPECT_KEPT(VerdictLine(Of(Verdict::kTie, three), "run.csv"));
  const std::string a(30, 'a'), b(30, 'b');
  EXPECT_KEPT(VerdictLine(Of(Verdict::kTie, {Without(a, 0.48, {b}), Without(b, 0.48, {a})}), "run.csv"));
}

TEST(VerdictLine, SaysWhatIsUnknownOrThatNothingWasFound) {
  Diagnosis d = Of(Verdict::kUnknown, {});
  d.unknown.probability = 0.97;
  EXPECT_KEPT(VerdictLine(d, "run.csv"));
  d.verdict = Verdict::kNone;
  EXPECT_KEPT(VerdictLine(d, "run.csv"));
  d.alarm_p = 0.4;
  EXPECT_KEPT(VerdictLine(d, "a/rather/long/way/to/the/folder/"));
}

TEST(VerdictLine, IsOneLineHoweverManyCausesThereAre) {
  const std::string line = VerdictLine(Of(Verdict::kNamed, std::vector<Cause>(9, Backlash())), "run.csv");
  EXPECT_LE(line.size(), 98u);
  EXPECT_NE(line.find("; and "), std::string::npos) << line;
}

}  // namespace
}  // namespace twinbench::report
