#include "twin/diagnose/words.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/diagnose/found_causes.h"

namespace twinbench::diagnose {
namespace {

using testing::HasSubstr;

TEST(WithUncertainty, HasTwoDigitsOfTheUncertainty) {
  const auto text = [](double value, double u) {
    return WithUncertainty({"roll", "mrad", 1.0, value, u, kNaN, kNaN});
  };
  EXPECT_EQ(text(12.3456, 0.123), "12.35 +- 0.12 mrad");
  EXPECT_EQ(text(180000.0, 2345.0), "180000 +- 2345 mrad");
  EXPECT_EQ(text(0.01, 8e-6), "0.0100000 +- 0.0000080 mrad");
  EXPECT_EQ(text(0.01, 8e-12), "0.01 +- 8e-12 mrad");
  EXPECT_EQ(text(1.5, kNaN), "1.5 mrad");
}

TEST(WithUncertainty, TellsSmallLengthsInMicrometres) {
  EXPECT_EQ(WithUncertainty({"width", "mm", 1e-3, 0.0004136e-3, 2.4e-9, kNaN, kNaN}), "0.4136 +- 0.0024 um");
  EXPECT_EQ(WithUncertainty({"width", "mm", 1e-3, 0.25e-3, 0.01e-3, kNaN, kNaN}), "0.250 +- 0.010 mm");
}

TEST(Percent, TellsLittleFromNothingAndFromUnknown) {
  EXPECT_EQ(Percent(0.974), "97 %");
  EXPECT_EQ(Percent(0.004), "< 1 %");
  EXPECT_EQ(Percent(0.0), "0 %");
  EXPECT_EQ(Percent(kNaN), "-");
}

TEST(GainInWords, TellsSizesInTheUnitOfTheRun) {
  const DiagnosisRun run = test::NamedRun(test::FoundPsdGain(0.003));
  EXPECT_THAT(GainInWords(run.diagnosis.gain, run.run), HasSubstr("from 0.71 to 0.31 um, noise alone leaves 0.3"));
}

TEST(GainInWords, WarnsOfAModelThatDoesNotPredictBetter) {
  DiagnosisRun run = test::NamedRun(test::FoundPsdGain(0.003));
  run.diagnosis.gain.positive = false;
  EXPECT_THAT(GainInWords(run.diagnosis.gain, run.run), HasSubstr("does not predict better"));
  run.diagnosis.gain.folds = 0;
  EXPECT_EQ(GainInWords(run.diagnosis.gain, run.run), "");
}

}  // namespace
}  // namespace twinbench::diagnose
