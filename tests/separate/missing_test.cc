#include <gtest/gtest.h>

#include "tests/separate/bench.h"
#include "twin/core/errors.h"

namespace twinbench::separate {
namespace {

struct Case {
  Truth truth;
  std::vector<Motion> motions;
};

Case FullCircles(int n, const std::vector<int>& shifts, Clamping clamping) {
  Stream stream(11, "test.truth");
  Case c{RandomTruth(n, stream), EmptyMotions(n, shifts, 1, ReadingCovariance())};
  FillExact(c.motions, c.truth, Layouts(n, clamping), Bench());
  return c;
}

void Lose(Motion& m, ReadingStatus status) {
  m.status = status;
  m.SetValues(Vector4::Constant(kNaN));
}

void ExpectTruth(const Separation& found, const Case& c) {
  const TableErrors target = RemoveNotSeparable(c.truth.target, Table::kTarget, found.not_separable);
  const TableErrors reference = RemoveNotSeparable(c.truth.reference, Table::kReference, found.not_separable);
  for (const Component k : {Component::kEx, Component::kEy, Component::kEz}) {
    // The chain's dz and the unseen dx enter in second order: 3 um / 0.1 m * 5 arcsec = 1e-4 arcsec, amplified
    // by 30.
    EXPECT_LT(RmsDifference(found.target.value[k], target[k]), 0.005 * units::arcsec);
    EXPECT_LT(RmsDifference(found.reference.value[k], reference[k]), 0.005 * units::arcsec);
  }
  EXPECT_LT(RmsDifference(found.target.value[Component::kDy], target[Component::kDy]), 0.005 * units::um);
}

TEST(Separate, DoesWithoutSomeReadings) {
  Case c = FullCircles(36, {0, 1, 7, 11}, Clamping::kReclamp);
  for (const std::size_t i : {3u, 40u, 41u, 75u, 100u, 143u}) Lose(c.motions[i], ReadingStatus::kSaturated);
  const Separation found = Separate(c.motions, Bench(), Options(36, Clamping::kReclamp));
  ExpectTruth(found, c);
  EXPECT_EQ(found.readings, 138);
  EXPECT_TRUE(std::isnan(found.residuals[40][0]));
}

TEST(Separate, MarksAPositionThatNobodyVisited) {
  Case c = FullCircles(12, {0, 1, 4}, Clamping::kReseat);
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
  Case c = FullCircles(12, {0, 1}, Clamping::kReseat);
  Lose(c.motions[4], ReadingStatus::kMissing);
  const Separation found = Separate(c.motions, Bench(), Options(12, Clamping::kReseat));
  int lost = 0;
  for (const double v : found.target.value[Component::kEz]) lost += std::isnan(v) ? 1 : 0;
  EXPECT_GE(lost, 11);  // one position may lie where the open slope crosses zero
}

TEST(Separate, AcceptsMountingConstantsOfEverySetUp) {
  Case c = FullCircles(36, {0, 1, 7, 11}, Clamping::kReclamp);
  for (Motion& m : c.motions) m.SetValues(m.Values() + 1e-5 * (m.setup + 1) * Vector4(1, -2, 3, 1));
  // Added, not turned: second order of 8 arcsec against 5 arcsec stays below the limits.
  ExpectTruth(Separate(c.motions, Bench(), Options(36, Clamping::kReclamp)), c);
}

TEST(Separate, RefusesAnglesOffTheGrid) {
  Case c = FullCircles(12, {0, 1}, Clamping::kReseat);
  c.motions[3].target_rad += 0.01;
  EXPECT_THROW(Separate(c.motions, Bench(), Options(12, Clamping::kReseat)), InputError);
}

TEST(Separate, RefusesAReferenceThatDoesNotTurnBack) {
  Case c = FullCircles(12, {0, 1}, Clamping::kReseat);
  for (Motion& m : c.motions) m.reference_rad = m.target_rad;
  EXPECT_THROW(Separate(c.motions, Bench(), Options(12, Clamping::kReseat)), InputError);
}

TEST(Separate, HasNoFullCircleToSeparateInAnEmptyRecord) {
  EXPECT_THROW(Separate({}, Bench(), Options(12, Clamping::kReseat)), InputError);
}

TEST(Separator, KnowsWhichMotionsFitItsLayout) {
  Case c = FullCircles(12, {0, 1, 4}, Clamping::kReseat);
  const Separator separator(c.motions, Bench(), Options(12, Clamping::kReseat));
  EXPECT_TRUE(separator.Fits(c.motions));
  Lose(c.motions[7], ReadingStatus::kOverrun);
  EXPECT_FALSE(separator.Fits(c.motions));
  EXPECT_THROW(separator.Separate(c.motions), std::logic_error);
}

}  // namespace
}  // namespace twinbench::separate
