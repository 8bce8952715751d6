#include "twin/separate/widest_range.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "twin/core/stream.h"

namespace twinbench::separate {
namespace {

TEST(WidestRange, OfOneSampleHasTheConstantsOfControlCharts) {
  struct Chart {
    int size;
    double d2, d3;
  };
  for (const Chart& c : {Chart{2, 1.128, 0.853}, {3, 1.693, 0.888}, {5, 2.326, 0.864}, {10, 3.078, 0.797}, {25, 3.931, 0.708}}) {
    const WidestRange range = WidestOf({{2.0, c.size}});
    EXPECT_NEAR(range.mean, 2.0 * c.d2, 2.0 * 0.001) << c.size << ": tables have three digits";
    EXPECT_NEAR(range.deviation, 2.0 * c.d3, 2.0 * 0.001) << c.size;
  }
}

TEST(WidestRange, OfTwoPairsIsThatOfTheLargerOfTwoHalfNormalNumbers) {
  // max(|a|, |b|) = (|a + b| + |a - b|) / 2, whose terms are independent; the range of a pair is sqrt(2) |a|.
  const WidestRange widest = WidestOf({{1.0, 2}, {1.0, 2}});
  EXPECT_NEAR(widest.mean, std::sqrt(2.0) * 2.0 / std::sqrt(std::numbers::pi), 1e-3);
  EXPECT_NEAR(widest.deviation, std::sqrt(2.0 * (1.0 - 2.0 / std::numbers::pi)), 1e-3);
}

TEST(WidestRange, OfSamplesOfManyScalesAndSizesIsWhatDrawsShow) {
  const std::vector<NormalSample> samples = {{1.0, 4}, {1.3, 3}, {0.2, 9}, {0.0, 5}, {1.1, 4}, {0.9, 7}};
  constexpr int kDraws = 20000;
  Stream normal(5, "test.ranges");
  double sum = 0.0, squares = 0.0;
  for (int d = 0; d < kDraws; ++d) {
    double widest = 0.0;
    for (const NormalSample& s : samples) {
      double most = -1e9, least = 1e9;
      for (int k = 0; k < s.size; ++k) {
        const double drawn = s.deviation * normal.Normal();
        most = std::max(most, drawn);
        least = std::min(least, drawn);
      }
      widest = std::max(widest, most - least);
    }
    sum += widest;
    squares += widest * widest;
  }
  const double mean = sum / kDraws, deviation = std::sqrt(squares / kDraws - mean * mean);
  const WidestRange widest = WidestOf(samples);
  EXPECT_NEAR(widest.mean, mean, 4.0 * deviation / std::sqrt(kDraws));
  EXPECT_NEAR(widest.deviation, deviation, 4.0 * deviation / std::sqrt(2.0 * kDraws));
}

TEST(WidestRange, OfNoScatterIsNone) {
  EXPECT_EQ(WidestOf({{0.0, 3}}).mean, 0.0);
  EXPECT_EQ(WidestOf({{0.0, 3}}).deviation, 0.0);
  EXPECT_THROW(WidestOf({{1.0, 1}}), std::logic_error);
  EXPECT_THROW(WidestOf({}), std::logic_error);
}

}  // namespace
}  // namespace twinbench::separate
