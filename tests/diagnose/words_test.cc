#include "twin/diagnose/words.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "tests/diagnose/found_causes.h"
#include "tests/diagnose/ring_run.h"
#include "twin/core/units.h"
#include "twin/diagnose/disagreement.h"
#include "twin/diagnose/recurrence.h"

namespace twinbench::diagnose {
namespace {

using testing::HasSubstr;

TEST(WithUncertainty, HasTwoDigitsOfTheUncertainty) {
  const auto text = [](double value, double u) {
    return WithUncertainty({"roll", "mrad", 1.0, value, u, kNaN, kNaN});
  };
  EXPECT_EQ(text(12.3456, 0.123), "12.35 ± 0.12 mrad");
  EXPECT_EQ(text(180000.0, 2345.0), "180000 ± 2345 mrad");
  EXPECT_EQ(text(0.01, 8e-6), "0.0100000 ± 0.0000080 mrad");
  EXPECT_EQ(text(0.01, 8e-12), "0.01 ± 8e-12 mrad");
  EXPECT_EQ(text(1.5, kNaN), "1.5 mrad");
}

TEST(WithUncertainty, TellsSmallLengthsInMicrometres) {
  EXPECT_EQ(WithUncertainty({"width", "mm", 1e-3, 0.0004136e-3, 2.4e-9, kNaN, kNaN}), "0.4136 ± 0.0024 µm");
  EXPECT_EQ(WithUncertainty({"width", "mm", 1e-3, 0.25e-3, 0.01e-3, kNaN, kNaN}), "0.250 ± 0.010 mm");
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

/// Readings with a direction of `size` that no unknown takes up, as found or not.
DiagnosisRun Off(double size_m, bool was_found) {
  DiagnosisRun found;
  found.run = test::MakeRing();
  test::AddRingNoise(found.run, 5);
  found.noise = test::WhiteNoise(found.run);
  Accepted direction = test::Direction(found.run);
  direction.amplitudes = Eigen::VectorXd::Constant(1, size_m);
  direction.family.amplitudes.front().prior_sd = size_m;
  // On both channels, that the middle of all rows shows it.
  for (int k = 0; k + 1 < found.run.Rows(); k += 2) direction.columns(k + 1, 0) = direction.columns(k, 0);
  found.run.residual += size_m * direction.columns;
  if (was_found) found.accepted = {direction};
  return found;
}

TEST(Disagreement, IsToldWhereItIsLargeAndCannotBeTrustedWhereNothingExplainsIt) {
  const Disagreement small = DisagreementOf(Off(1e-6, false)), explained = DisagreementOf(Off(1e-3, true)),
                     open = DisagreementOf(Off(1e-3, false));
  EXPECT_TRUE(small.is_plausible && explained.is_plausible && !open.is_plausible);
  EXPECT_EQ(small.line, "");
  EXPECT_THAT(explained.line, HasSubstr("times their noise"));
  EXPECT_THAT(open.line, HasSubstr("are they of this bench"));
}

constexpr int kEightTurns = 480, kStopsOfATurn = 60;

/// Eight turns of one channel that shows a wave of five periods a turn.
LinearRun EightTurns() {
  LinearRun run;
  run.channels = {"angle"};
  Schedule& s = run.schedule = PlainSchedule(kEightTurns);
  run.observed.resize(kEightTurns);
  for (int i = 0; i < kEightTurns; ++i) {
    s.pass[static_cast<std::size_t>(i)] = i / kStopsOfATurn;
    s.reference_rad[i] = units::turn * i / kStopsOfATurn;
    run.observed[i] = std::sin(5.0 * s.reference_rad[i] + 0.1);
  }
  run.residual = Eigen::VectorXd::Zero(kEightTurns);
  return run;
}

TEST(Recurrence, OfScatteredValuesIsHardlyEverSeen) {
  const LinearRun run = EightTurns();
  std::mt19937_64 random(5);
  int seen = 0;
  constexpr int kTrials = 2000;
  for (int k = 0; k < kTrials; ++k) {
    std::vector<int> rows;
    for (int i = 0; i < kEightTurns; ++i) {
      if (random() % 60 == 0) rows.push_back(i);
    }
    seen += RecurrenceOf(rows, run).empty() ? 0 : 1;
  }
  EXPECT_LE(seen, kTrials / 250);
}

TEST(Recurrence, InARowAtOneAngleOrAtOneShownValueIsSaidButNotOfTwoValues) {
  const LinearRun run = EightTurns();
  const std::pair<std::vector<int>, const char*> cases[] = {
      {{200, 201, 202, 203, 377}, "in a row"},
      {{7, 67, 187, 247, 300}, "at 42 deg, synchronous with reference angle"},
      {{59, 179, 180, 299, 300, 420}, "at 354 deg, synchronous with reference angle"},  // on both sides of zero
      // The same crest in other periods: other angles.
      {{27, 75, 123 + 60 * 2, 171 + 60, 219 + 60 * 3, 3 + 60 * 7}, "where angle shows the same"}};
  for (const auto& [rows, words] : cases) EXPECT_THAT(RecurrenceOf(rows, run), HasSubstr(words));
  EXPECT_THAT(RecurrenceOf({59, 60, 119, 120}, run), testing::Not(HasSubstr("in a row"))) << "of two passes";
  EXPECT_EQ(RecurrenceOf({7, 67}, run), "");
}

}  // namespace
}  // namespace twinbench::diagnose
