#include <gtest/gtest.h>

#include "tests/separate/bench.h"
#include "twin/core/errors.h"

namespace twinbench::separate {
namespace {

void Lose(Motion& m, ReadingStatus status) {
  m.status = status;
  m.SetValues(Vector4::Constant(kNaN));
}

void ExpectTruth(const Separation& found, const ExactCircles& c) {
  const auto tables = test::BothTables(found, c.truth);
  for (const test::SeparatedTable& t : tables) {
    // The chain's dz and the unseen dx enter in second order: 3 um / 0.1 m * 5 arcsec = 1e-4 arcsec, amplified
    // by 30.
    for (const Component k : {Component::kEx, Component::kEy, Component::kEz})
      EXPECT_LT(t.RmsError(k), 0.005 * units::arcsec) << t.Name(k);
  }
  EXPECT_LT(tables[0].RmsError(Component::kDy), 0.005 * units::um);
}

TEST(Separate, DoesWithoutSomeReadings) {
  ExactCircles c = ReadExactly(36, {0, 1, 7, 11}, Clamping::kReclamp);
  for (const std::size_t i : {3u, 40u, 41u, 75u, 100u, 143u}) Lose(c.motions[i], ReadingStatus::kSaturated);
  const Separation found = Separate(c.motions, Bench(), Options(36, Clamping::kReclamp));
  ExpectTruth(found, c);
  EXPECT_EQ(found.readings, 138);
  EXPECT_TRUE(std::isnan(found.residuals[40][0]));
}

TEST(Separate, MarksAPositionThatNobodyVisited) {
  ExactCircles c = ReadExactly(12, {0, 1, 4}, Clamping::kReseat);
  for (Motion& m : c.motions) {
    if (m.position == 5) Lose(m, ReadingStatus::kNoLight);
  }
  for (auto& column : c.truth.target.value) column[5] = kNaN;
  const Separation found = Separate(c.motions, Bench(), Options(12, Clamping::kReseat));
  EXPECT_TRUE(std::isnan(found.target.value[Component::kEz][5]));
  EXPECT_TRUE(std::isfinite(found.target.value[Component::kEz][6]));
  EXPECT_FALSE(found.notes.empty());
  EXPECT_TRUE(ToJson(found)["target"]["ez_arcsec"][5].is_null());
  ExpectTruth(found, c);
}

TEST(Separate, LosesEverythingThatATornRingLeavesOpen) {
  // Two set-ups close one ring of n links; without one link its slope (the set-up's constant) is free.
  ExactCircles c = ReadExactly(12, {0, 1}, Clamping::kReseat);
  Lose(c.motions[4], ReadingStatus::kMissing);
  const Separation found = Separate(c.motions, Bench(), Options(12, Clamping::kReseat));
  int lost = 0;
  for (const double v : found.target.value[Component::kEz]) lost += std::isnan(v) ? 1 : 0;
  EXPECT_GE(lost, 11);  // one position may lie where the open slope crosses zero
}

TEST(Separate, AcceptsMountingConstantsOfEverySetUp) {
  ExactCircles c = ReadExactly(36, {0, 1, 7, 11}, Clamping::kReclamp);
  for (Motion& m : c.motions) m.SetValues(m.Values() + 1e-5 * (m.setup + 1) * Vector4(1, -2, 3, 1));
  // Added, not turned: second order of 8 arcsec against 5 arcsec stays below the limits.
  ExpectTruth(Separate(c.motions, Bench(), Options(36, Clamping::kReclamp)), c);
}

TEST(Separate, RefusesAnglesOffTheGridAReferenceThatDoesNotTurnBackAndAnEmptyRecord) {
  const std::vector<Motion> right = ReadExactly(12, {0, 1}, Clamping::kReseat).motions;
  std::vector<Motion> off_grid = right, not_back = right;
  off_grid[3].target_rad += 0.01;
  for (Motion& m : not_back) m.reference_rad = m.target_rad;
  for (const std::vector<Motion>& motions : {off_grid, not_back, {}})
    EXPECT_THROW(Separate(motions, Bench(), Options(12, Clamping::kReseat)), InputError) << motions.size();
}

TEST(Separator, KnowsWhichMotionsFitItsLayout) {
  ExactCircles c = ReadExactly(12, {0, 1, 4}, Clamping::kReseat);
  const Separator separator(c.motions, Bench(), Options(12, Clamping::kReseat));
  EXPECT_TRUE(separator.Fits(c.motions));
  Lose(c.motions[7], ReadingStatus::kOverrun);
  EXPECT_FALSE(separator.Fits(c.motions));
  EXPECT_THROW(separator.Separate(c.motions), std::logic_error);
}

}  // namespace
}  // namespace twinbench::separate
