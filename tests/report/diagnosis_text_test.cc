#include "twin/report/diagnosis_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/diagnose/found_causes.h"
#include "tests/report/page_lines.h"
#include "twin/core/units.h"
#include "twin/diagnose/words.h"
#include "twin/report/text_table.h"

namespace twinbench::report {
namespace {

using diagnose::Cause;
using diagnose::DiagnosisRun;
using diagnose::Shown;
using diagnose::Verdict;
using testing::AllOf;
using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

/// A device with one error at each of three angles.
Shown ShownOf(const std::vector<double>& share) {
  Shown shown;
  shown.share = share;
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
  return DiagnosisText({run, ShownOf(share), "run.csv"}, style);
}

/// Where a line that begins like this stands; fails if there is none.
std::size_t LineOf(const std::vector<std::string>& lines, const std::string& begin) {
  for (std::size_t k = 0; k < lines.size(); ++k) {
    if (lines[k].starts_with(begin)) return k;
  }
  ADD_FAILURE() << "no line begins with " << begin;
  return 0;
}

TEST(DiagnosisText, IsInTheReadersOrder) {
  DiagnosisRun run = Named();
  run.diagnosis.causes[0].next_measurement = "a tilt sweep";
  run.diagnosis.notes = {"no column temperature_degC"};
  run.diagnosis.harmonics = {{1, 3e-6, 1e-7, 0.1, 0.03, "off centre"}};
  const auto lines = test::LinesOf(Page(run));
  EXPECT_THAT(lines[0], StartsWith("Named: psd_gain at psd_a_x, gain error 0.00312 +- 0.00020 (97 %)"));
  std::size_t before = 0;
  for (const char* begin :
       {"Causes", "psd_gain at psd_a_x", "Next: a tilt sweep", "Harmonics", "    1",
        "What the scenario leaves of angle [deg] against the angle", "Gain: ", "! no column", "--verbose"}) {
    const std::size_t at = LineOf(lines, begin);
    EXPECT_GT(at, before) << begin;
    before = at;
  }
}

TEST(DiagnosisText, GivesEachCauseItsSizesProbabilityAndShare) {
  DiagnosisRun run = Named();
  run.diagnosis.causes[0].parameters.push_back({"phase", "deg", units::deg, kNaN, kNaN, kNaN, kNaN});
  run.diagnosis.causes[0].parameters.push_back({"offset", "um", 1e-6, 2e-6, kNaN, kNaN, kNaN});
  const auto lines = test::LinesOf(Page(run));
  const std::size_t at = LineOf(lines, "psd_gain at psd_a_x");
  EXPECT_THAT(lines[at], AllOf(HasSubstr("  gain error 0.00312 +- 0.00020  "), EndsWith("97 %   93 %")));
  // What it is, and the parameter without an uncertainty; the one that was not determined is not told.
  EXPECT_THAT(lines[at + 1], AllOf(StartsWith("  gain of one PSD axis"), EndsWith("offset 2 um")));
  EXPECT_THAT(Page(run), Not(HasSubstr("nan")));
}

TEST(DiagnosisText, ShowsATieOnce) {
  DiagnosisRun run = Named();
  run.diagnosis.verdict = Verdict::kTie;
  Cause rival = run.diagnosis.causes[0];
  rival.effect = "stray_light";
  rival.where = "psd_a";
  rival.parameters.clear();
  rival.indistinguishable_from = {{"psd_gain", "psd_a_x", 0.97}};
  rival.next_measurement = run.diagnosis.causes[0].next_measurement = "a tilt sweep";
  run.diagnosis.causes[0].indistinguishable_from = {{"stray_light", "psd_a", 0.96}};
  run.diagnosis.causes.push_back(rival);
  const std::string text = Page(run, {}, {0.93, kNaN});
  const auto lines = test::LinesOf(text);
  EXPECT_THAT(lines[LineOf(lines, "or stray_light at psd_a")], HasSubstr("can imitate 96 % of it"));
  EXPECT_EQ(text.find("imitate"), text.rfind("imitate"));
  EXPECT_EQ(text.find("a tilt sweep"), text.rfind("a tilt sweep"));
  EXPECT_EQ(text.find("93 %"), text.rfind("93 %"));  // the share of both
}

TEST(DiagnosisText, GivesTheSignatureOfTheUnknown) {
  DiagnosisRun run;
  run.diagnosis.verdict = Verdict::kUnknown;
  run.diagnosis.unknown = {0.97, "order 7 locked to the angle | a step"};
  const auto lines = test::LinesOf(Page(run, {}, {}));
  const std::size_t at = LineOf(lines, "structure without a name");
  EXPECT_THAT(lines[at], AllOf(HasSubstr("order 7 locked to the angle"), HasSubstr("97 %")));
  EXPECT_THAT(lines[at + 1], EndsWith("  a step"));
}

TEST(DiagnosisText, ShowsOrdersThatNoiseDoesNotGiveInTheUnitOfTheRun) {
  DiagnosisRun run = Named();
  const std::string screws = "screws or poles";
  run.diagnosis.harmonics = {{3, 2.5e-6, 1e-7, 0.0, 0.01, screws},
                             {5, 2.5e-6, 1e-7, 0.0, 0.01, screws},
                             {6, 1e-7, 1e-7, 0.0, 1.0, "nothing"}};
  const std::string text = Page(run);
  EXPECT_THAT(text, AllOf(HasSubstr("2.50 +- 0.10 um"), HasSubstr("as order 3"), Not(HasSubstr("nothing"))));
  EXPECT_THAT(text, HasSubstr("all harmonics"));
  const std::string verbose = Page(run, {.verbose = true});
  EXPECT_THAT(verbose, AllOf(HasSubstr("nothing"), Not(HasSubstr("all harmonics"))));
}

TEST(DiagnosisText, OfACleanRunIsShortAndKeepsTheRestForVerbose) {
  DiagnosisRun run;
  run.diagnosis.readings = 624;
  run.diagnosis.detectable = {{"psd_gain", "psd_a_x", {"gain_error", "1", 1.0, 4e-4, kNaN, kNaN, kNaN}}};
  run.diagnosis.invisible = {{"backlash", "target", "target ez up to 0.4 arcsec rms"}};
  run.diagnosis.noise = {"tails like Student's t"};
  run.diagnosis.left_out = 3;
  const std::string text = Page(run, {}, {});
  EXPECT_THAT(text,
              AllOf(StartsWith("Agrees: nothing found in 624 readings of run.csv"),
                    HasSubstr("! 3 readings without usable values were left out"), Not(HasSubstr("psd_gain")),
                    HasSubstr("--verbose adds 3 further remarks: noise, smallest sizes seen, what cannot be")));
  EXPECT_THAT(Page(run, {.verbose = true}, {}),
              AllOf(HasSubstr("gain error 0.0004\n"), HasSubstr("target ez up to 0.4 arcsec rms"),
                    HasSubstr("Noise: tails like Student's t"), Not(HasSubstr("--verbose"))));
}

TEST(DiagnosisText, KeepsWarningsInTheShortForm) {
  DiagnosisRun run = Named();
  run.diagnosis.gain.positive = false;
  EXPECT_THAT(Page(run), AllOf(HasSubstr("! on passes that it was not fitted to"), Not(HasSubstr("Gain:"))));
  // The diagnosis itself may have said so.
  run.diagnosis.notes = {diagnose::kNoGainNote};
  EXPECT_THAT(Page(run), AllOf(HasSubstr("! the gain on held-out"), Not(HasSubstr("! on passes"))));
  DiagnosisRun clean;
  diagnose::ScreenTest loud;
  loud.name = "raw: hum";
  loud.p = 1e-9;
  const Shown shown = ShownOf({});
  EXPECT_THAT(DiagnosisText({clean, shown, "run", {loud}}, {}),
              HasSubstr("! 1 of 1 residual tests stand out nevertheless: raw: hum\n"));
}

TEST(DiagnosisText, IsPlainTextOfAtMost80Columns) {
  DiagnosisRun run = Named();
  for (int k = 0; k < 3; ++k) run.diagnosis.causes.push_back(run.diagnosis.causes[0]);
  run.diagnosis.notes = {std::string(40, 'a') + " " + std::string(60, 'b')};
  for (const Letters letters : {Letters::kAscii, Letters::kUnicode}) {
    const std::string text = Page(run, {letters, true});
    EXPECT_EQ(text.find('\x1b'), std::string::npos);
    const auto lines = test::LinesOf(text);
    for (std::size_t k = 1; k < lines.size(); ++k) EXPECT_LE(WidthOf(lines[k]), 80u) << lines[k];
  }
  for (const char c : Page(run)) EXPECT_LT(static_cast<unsigned char>(c), 0x80);
}

}  // namespace
}  // namespace twinbench::report
