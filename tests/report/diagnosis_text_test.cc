#include "tests/diagnose/found_causes.h"
#include "tests/report/page_lines.h"
#include "tests/support/kept_text.h"
#include "twin/diagnose/words.h"
#include "twin/report/text_table.h"
#include "twin/report/verdict_line.h"

namespace twinbench::report {
namespace {

using diagnose::Cause, diagnose::DiagnosisRun, diagnose::Shown, diagnose::Verdict, testing::AllOf;

/// A device with one error at each of three angles.
Shown WithCurve() {
  Shown shown;
  shown.share = {0.93};
  shown.curve = {"angle", "deg", "angle", "deg", {0.0, 120.0, 240.0}, {1.0, 2.0, 3.0}, {0.0, 1.0, 2.0}};
  return shown;
}

DiagnosisRun Named() {
  DiagnosisRun run = diagnose::test::NamedRun(diagnose::test::FoundPsdGain(0.00312));
  run.run.channels = {"psd_a_x", "psd_a_y"};
  run.diagnosis.alarm_p = 1e-5;
  run.diagnosis.readings = 624;
  return run;
}

std::string Page(const DiagnosisRun& run, const PageStyle& style = {}, const std::vector<double>& share = {0.93}) {
  Shown shown;
  shown.share = share;
  return DiagnosisText({run, shown, "run.csv"}, style);
}

TEST(DiagnosisText, IsInTheReadersOrder) {
  DiagnosisRun run = Named();
  run.diagnosis.causes[0].next_measurement = "a tilt sweep";
  run.diagnosis.notes = {"no column temperature_degC"};
  run.diagnosis.harmonics = {{1, 3e-6, 1e-7, 0.1, 0.03, "off centre"}};
  EXPECT_KEPT(DiagnosisText({run, WithCurve(), "run.csv"}, {}));
}

TEST(DiagnosisText, GivesEachCauseItsSizesProbabilityAndShareAndNotWhatWasNotDetermined) {
  DiagnosisRun run = Named();
  run.diagnosis.causes[0].parameters.push_back({"phase", "deg", units::deg, kNaN, kNaN, kNaN, kNaN});
  run.diagnosis.causes[0].parameters.push_back({"offset", "um", 1e-6, 2e-6, kNaN, kNaN, kNaN});
  EXPECT_KEPT(Page(run));
}

/// What one can imitate of the other, the share of both and the next measurement: each stands there once.
TEST(DiagnosisText, ShowsATieOnce) {
  DiagnosisRun run = Named();
  run.diagnosis.verdict = Verdict::kTie;
  run.diagnosis.causes[0].probability = 0.48;
  Cause rival = run.diagnosis.causes[0];
  rival.effect = "stray_light";
  rival.where = "psd_a";
  rival.parameters.clear();
  rival.indistinguishable_from = {{"psd_gain", "psd_a_x", 0.97}};
  rival.next_measurement = run.diagnosis.causes[0].next_measurement = "a tilt sweep";
  run.diagnosis.causes[0].indistinguishable_from = {{"stray_light", "psd_a", 0.96}};
  run.diagnosis.causes.push_back(rival);
  EXPECT_KEPT(Page(run, {}, {0.93, kNaN}));
}

TEST(DiagnosisText, GivesTheSignatureOfTheUnknown) {
  DiagnosisRun run;
  run.diagnosis.verdict = Verdict::kUnknown;
  run.diagnosis.unknown = {0.97, "order 7 synchronous with the angle | a step"};
  EXPECT_KEPT(Page(run, {}, {}));
}

TEST(DiagnosisText, ShowsOrdersThatNoiseDoesNotGiveInTheUnitOfTheRunAndAllForVerbose) {
  DiagnosisRun run = Named();
  const std::string screws = "screws or poles";
  run.diagnosis.harmonics = {{3, 2.5e-6, 1e-7, 0.0, 0.01, screws},
                             {5, 2.5e-6, 1e-7, 0.0, 0.01, screws},
                             {6, 1e-7, 1e-7, 0.0, 1.0, "nothing"}};
  for (const bool verbose : {false, true}) EXPECT_KEPT(Page(run, {.verbose = verbose}));
}

TEST(DiagnosisText, OfACleanRunIsShortAndKeepsTheRestForVerbose) {
  DiagnosisRun run;
  run.diagnosis.readings = 624;
  run.diagnosis.detectable = {{"psd_gain", "psd_a_x", {"gain_error", "1", 1.0, 4e-4, kNaN, kNaN, kNaN}}};
  run.diagnosis.invisible = {{"backlash", "target", "target ez up to 0.4 arcsec rms"}};
  run.diagnosis.noise = {"tails like Student's t"};
  run.diagnosis.left_out = 3;
  for (const bool verbose : {false, true}) EXPECT_KEPT(Page(run, {.verbose = verbose}, {}));
}

TEST(DiagnosisText, KeepsWarningsInTheShortForm) {
  DiagnosisRun run = Named();
  run.diagnosis.gain.positive = false;
  EXPECT_KEPT(Page(run));
  run.diagnosis.notes = {diagnose::kNoGainNote};  // the diagnosis itself may have said so
  EXPECT_KEPT(Page(run));
  diagnose::ResidualTest test;
  test.name = "periodogram";
  test.p = 1e-9;
  EXPECT_KEPT(DiagnosisText({DiagnosisRun{}, Shown{}, "run", {test}}, {}));
}

TEST(DiagnosisText, IsPlainTextOfAtMost80Columns) {
  DiagnosisRun run = Named();
  for (int k = 0; k < 3; ++k) run.diagnosis.causes.push_back(run.diagnosis.causes[0]);
  run.diagnosis.notes = {std::string(40, 'a') + " " + std::string(60, 'b')};
  for (const Letters letters : {Letters::kAscii, Letters::kUnicode}) {
    const std::string text = DiagnosisText({run, WithCurve(), "run.csv"}, {letters, true});
    EXPECT_EQ(text.find('\x1b'), std::string::npos);
    const auto lines = test::LinesOf(text);
    for (std::size_t k = 1; k < lines.size(); ++k) EXPECT_LE(WidthOf(lines[k]), 80u) << lines[k];
  }
  for (const std::string& line : test::LinesOf(DiagnosisText({run, WithCurve(), "run.csv"}, {}))) {
    const bool is_ascii = std::ranges::all_of(line, [](char c) { return static_cast<unsigned char>(c) < 0x80; });
    EXPECT_TRUE(is_ascii || line.find('|') == line.npos) << "the plot: " << line;
  }
}

using diagnose::Diagnosis;

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

/// A tie has the share of whichever of it was fitted; what has none stands last.
TEST(VerdictLine, BeginsWithWhatExplainsMost) {
  const std::vector<Cause> causes = {Without("small", 0.9, {}), Without("a", 0.48, {"b"}), Without("b", 0.48, {"a"}), Without("none", 0.9, {})};
  const std::string line = VerdictLine(Of(Verdict::kTie, causes), "run.csv", {0.2, kNaN, 0.7, kNaN});
  EXPECT_LT(line.find("a or b"), line.find("small")) << line;
  EXPECT_LT(line.find("small"), line.find("none")) << line;
}

TEST(VerdictLine, LeavesOutWhatIsLessLikelyThanNot) {
  const std::string line = VerdictLine(Of(Verdict::kNamed, {Backlash(), Without("drift", 0.01, {}), Without("periodic", 0.06, {})}), "run.csv");
  EXPECT_EQ(line.find("drift"), std::string::npos) << line;
  EXPECT_EQ(line.find("periodic"), std::string::npos) << line;
  EXPECT_NE(line.find("backlash"), std::string::npos) << line;
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
