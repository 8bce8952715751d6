#include "twin/separate/shift_transfer.h"

#include <gtest/gtest.h>

#include <cmath>

#include "twin/core/units.h"

namespace twinbench::separate::shifts {
namespace {

ShiftSet Even(int n, const std::vector<int>& shifts) {
  return {n, shifts, std::vector<double>(shifts.size(), 1.0)};
}

TEST(Transfers, HaveTheVarianceOfTwoSetUpsInClosedForm) {
  // |1 + z|^2 = 4 cos^2, so that the factor is 1 / sin^2(pi k / n): 1.3e8 for the first of 36 000 stops, where
  // 1 - |S|^2 / 4 keeps eight digits only.
  for (const int n : {36, 360, 36000}) {
    const auto transfers = Transfers(Even(n, {0, 1}));
    for (const int k : {1, 2, 7, n / 4, n / 2}) {
      const double factor = 1.0 / std::pow(std::sin(units::kPi * k / n), 2);
      EXPECT_NEAR(transfers[static_cast<std::size_t>(k)].VarianceFactor() / factor, 1.0, 1e-12) << n << ' ' << k;
    }
  }
}

TEST(Transfers, AreBestForADifferenceSet) {
  // {0, 1, 3, 9} meets every difference modulo 13 once: |S_k|^2 = 4 - 1 for every k.
  for (const HarmonicTransfer& t : Transfers(Even(13, {0, 1, 3, 9}))) {
    if (t.order == 0) continue;
    EXPECT_NEAR(t.VarianceFactor(), 16.0 / 13.0, 1e-13);
  }
}

TEST(Transfers, WeighSetUps) {
  // Two set-ups of weights 3 and 1: |3 + z|^2 = 10 + 6 cos.
  const auto transfers = Transfers({12, {0, 1}, {3.0, 1.0}});
  for (int k = 1; k <= 6; ++k) {
    const double determinant = 16.0 - 10.0 - 6.0 * std::cos(units::turn * k / 12);
    EXPECT_NEAR(transfers[static_cast<std::size_t>(k)].determinant, determinant, 1e-13);
  }
}

TEST(LostHarmonics, AreTheMultiplesThatAllShiftsShowAlike) {
  EXPECT_EQ(LostHarmonics(Even(12, {0, 1, 4})), std::vector<int>{});
  EXPECT_EQ(LostHarmonics(Even(12, {0, 4, 10})), std::vector<int>{6});
  EXPECT_EQ(LostHarmonics(Even(36, {5, 14, -4})), (std::vector<int>{4, 8, 12, 16}));
  EXPECT_EQ(LostHarmonics(Even(5, {2, 2})), (std::vector<int>{1, 2}));
}

TEST(ValueVariance, IsTheNoiseGainOfTheShiftTables) {
  // Two set-ups: (n^2 - 1) / (6 n) (docs/theory.md, 2); four at n = 36: 0.579.
  for (const int n : {12, 36, 360})
    EXPECT_NEAR(ValueVariance(Even(n, {0, 1})), (n * n - 1.0) / (6.0 * n), 1e-10 * n);
  EXPECT_NEAR(std::sqrt(ValueVariance(Even(36, {0, 1, 7, 11}))), 0.579, 5e-4);
}

TEST(Transfers, RefuseWeightsThatAreNone) {
  EXPECT_THROW(Transfers({12, {0, 1}, {1.0, 0.0}}), std::logic_error);
  EXPECT_THROW(Transfers({12, {0, 1}, {1.0}}), std::logic_error);
}

}  // namespace
}  // namespace twinbench::separate::shifts
