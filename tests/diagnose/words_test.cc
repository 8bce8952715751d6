#include "twin/diagnose/words.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "tests/diagnose/found_causes.h"

namespace twinbench::diagnose {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// Without line breaks, so that the wrapping does not matter.
std::string Flat(const DiagnosisRun& run) {
  std::string text = InWords(run);
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

DiagnosisRun Named() {
  DiagnosisRun run = test::NamedRun(test::FoundPsdGain(0.00312));
  run.diagnosis.alarm_p = 1e-5;
  run.diagnosis.readings = 624;
  return run;
}

TEST(InWords, SaysWhatWasFoundHowSureAndWhatItBuys) {
  EXPECT_THAT(Flat(Named()),
              AllOf(HasSubstr("do not agree with the scenario (a chance below 1 in 1000)"),
                    HasSubstr("psd_gain at psd_a_x (gain of one PSD axis and its amplifier): gain error 0.00312 +- "
                              "0.00020, probability 97 %"),
                    HasSubstr("falls from 0.71 to 0.31 um, where noise alone leaves 0.3 um: 97 % (95 % interval 95 "
                              "% to 99 %)")));
}

TEST(InWords, ListsTheMembersOfATieAndWhatWouldTell) {
  DiagnosisRun run = Named();
  run.diagnosis.verdict = Verdict::kTie;
  Cause rival = run.diagnosis.causes[0];
  rival.effect = "stray_light";
  rival.where = "psd_a";
  rival.next_measurement = run.diagnosis.causes[0].next_measurement = "a tilt sweep";
  run.diagnosis.causes.push_back(rival);
  const std::string text = Flat(run);
  EXPECT_THAT(text, AllOf(HasSubstr("cannot tell which of these it is: psd_gain at psd_a_x"),
                          HasSubstr("; stray_light at psd_a"), HasSubstr("What would tell: a tilt sweep. ")));
}

TEST(InWords, GivesTheSignatureOfTheUnknown) {
  DiagnosisRun run;
  run.diagnosis.verdict = Verdict::kUnknown;
  run.diagnosis.unknown.signature = "order 7 locked to the reference angle";
  EXPECT_THAT(Flat(run),
              HasSubstr("No cause of the catalogue explains it: order 7 locked to the reference angle."));
}

TEST(InWords, OfACleanRunSaysWhatWouldHaveBeenSeen) {
  DiagnosisRun run;
  run.diagnosis.readings = 624;
  run.diagnosis.detectable = {{"psd_gain", "psd_a_x", {"gain_error", "1", 1.0, 4e-4, kNaN, kNaN, kNaN}}};
  run.diagnosis.invisible = {{"backlash", "target", "target ez up to 0.4 arcsec rms"}};
  run.diagnosis.left_out = 3;
  EXPECT_THAT(Flat(run), AllOf(HasSubstr("The readings agree with the scenario: nothing was found in 624 readings"),
                               HasSubstr("larger than, for example, psd_gain at psd_a_x: gain error 0.0004."),
                               HasSubstr("cannot see backlash at target (target ez up to 0.4 arcsec rms)"),
                               HasSubstr("Left out: 3 readings"), Not(HasSubstr("nan"))));
}

TEST(InWords, WarnsOfAModelThatDoesNotPredictBetter) {
  DiagnosisRun run = Named();
  run.diagnosis.gain.positive = false;
  EXPECT_THAT(Flat(run), HasSubstr("does not predict better"));
}

TEST(InWords, KeepsLinesShort) {
  std::istringstream in(InWords(Named()));
  for (std::string line; std::getline(in, line);) EXPECT_LE(line.size(), 100u);
}

TEST(WithUncertainty, HasTwoDigitsOfTheUncertainty) {
  const auto text = [](double value, double u) {
    return WithUncertainty({"roll", "mrad", 1.0, value, u, kNaN, kNaN});
  };
  EXPECT_EQ(text(12.3456, 0.123), "12.35 +- 0.12 mrad");
  EXPECT_EQ(text(180000.0, 2345.0), "180000 +- 2345 mrad");
  EXPECT_EQ(text(1.5, kNaN), "1.5 mrad");
}

}  // namespace
}  // namespace twinbench::diagnose
