#include "twin/diagnose/recurrence.h"

#include <gmock/gmock.h>

#include <random>

#include "twin/core/units.h"

namespace twinbench::diagnose {
namespace {

using testing::HasSubstr;

constexpr int kEightTurns = 480, kStopsOfATurn = 60;

/// Eight turns of one channel that shows a wave of five periods a turn.
LinearRun EightTurns() {
  LinearRun run;
  run.channels = {"angle"};
  Schedule& s = run.schedule;
  s.reference_rad.resize(kEightTurns);
  run.observed.resize(kEightTurns);
  for (int i = 0; i < kEightTurns; ++i) {
    s.reading.push_back(i);
    s.setup.push_back(0);
    s.pass.push_back(i / kStopsOfATurn);
    s.phase.push_back(Phase::kFullCircle);
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

TEST(Recurrence, InARowIsSaid) {
  EXPECT_THAT(RecurrenceOf({200, 201, 202, 203, 377}, EightTurns()), HasSubstr("in a row"));
  EXPECT_EQ(RecurrenceOf({59, 60, 119, 120}, EightTurns()).find("in a row"), std::string::npos) << "of two passes";
}

TEST(Recurrence, AtOneAngleIsSaid) {
  EXPECT_THAT(RecurrenceOf({7, 67, 187, 247, 300}, EightTurns()),
              HasSubstr("at 42 deg, locked to reference angle"));
}

TEST(Recurrence, OnBothSidesOfZeroIsAtOneAngle) {
  EXPECT_THAT(RecurrenceOf({59, 179, 180, 299, 300, 420}, EightTurns()), HasSubstr("at 354 deg, locked to reference angle"));
}

TEST(Recurrence, AtOneShownValueIsSaid) {
  // The same crest in other periods: other angles.
  EXPECT_THAT(RecurrenceOf({27, 75, 123 + 60 * 2, 171 + 60, 219 + 60 * 3, 3 + 60 * 7}, EightTurns()),
              HasSubstr("where angle shows the same"));
}

TEST(Recurrence, OfTwoValuesIsNotAskedFor) {
  EXPECT_EQ(RecurrenceOf({7, 67}, EightTurns()), "");
}

}  // namespace
}  // namespace twinbench::diagnose
