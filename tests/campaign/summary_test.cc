#include "twin/campaign/summary.h"

#include <gmock/gmock.h>

#include <cmath>

#include "twin/core/reading.h"

namespace twinbench::campaign {
namespace {

TEST(Summary, HasMeanScatterBiasAndCoverage) {
  Summary summary;
  // Values 9, 11, 13, 15 with u = 1 against the truth 10: errors -1, 1, 3, 5, of which two are within 1.96 u.
  for (int trial = 0; trial < 4; ++trial) {
    const double value = 9.0 + 2.0 * trial;
    summary.Add({trial, "", "", {{"a", value, 1.0, value - 10.0}}});
  }
  summary.Add({4, "no light", "", {}});
  const ResultSummary a = summary.Results().at("a");
  EXPECT_EQ(a.count, 4);
  EXPECT_DOUBLE_EQ(a.mean, 12.0);
  EXPECT_DOUBLE_EQ(a.sd, std::sqrt(20.0 / 3.0));
  EXPECT_DOUBLE_EQ(a.rms_u, 1.0);
  EXPECT_DOUBLE_EQ(a.bias, 2.0);
  EXPECT_DOUBLE_EQ(a.coverage95, 0.5);
  ASSERT_EQ(summary.Lost().size(), 1u);
  EXPECT_EQ(summary.Lost()[0].trial, 4);
  ASSERT_EQ(summary.Worst(1).size(), 1u);
  EXPECT_EQ(summary.Worst(1)[0].trial, 3);
  EXPECT_DOUBLE_EQ(summary.Worst(1)[0].normed, 5.0);
}

/// An error of 2.5 u is inside the interval of 5 degrees of freedom (k = 2.57) and outside that of many.
TEST(Summary, CountsByTheCoverageFactorOfEachResult) {
  Summary summary;
  summary.Add({0, "", "", {{"few", 0.0, 1.0, 2.5, 2.57}, {"many", 0.0, 1.0, 2.5}}});
  EXPECT_DOUBLE_EQ(summary.Results().at("few").coverage95, 1.0);
  EXPECT_DOUBLE_EQ(summary.Results().at("many").coverage95, 0.0);
}

TEST(Summary, TakesTheNumbersOfAListTogetherEachAboutItsOwnMean) {
  Summary summary;
  const auto add = [&](int trial, double c0, double c1, double s0, double s1) {
    summary.Add({trial, "", "", {{"c[0]", c0, 1.0, kNaN}, {"c[1]", c1, 1.0, kNaN},
                                 {"s[0]", 0.0, 1.0, s0}, {"s[1]", 0.0, 1.0, s1}}});
  };
  add(0, 1.0, 101.0, 2.0, -4.0);
  add(1, 3.0, 103.0, 4.0, -2.0);
  const ResultSummary c = summary.Results().at("c[]");
  EXPECT_EQ(c.count, 4);
  EXPECT_DOUBLE_EQ(c.mean, 52.0);
  EXPECT_DOUBLE_EQ(c.sd, std::sqrt(2.0));  // each pair has 2 about its mean with one degree of freedom
  EXPECT_TRUE(std::isnan(c.coverage95));
  // Biases 3 and -3: they would cancel in a mean.
  EXPECT_DOUBLE_EQ(summary.Results().at("s[]").bias, 3.0);
}

}  // namespace
}  // namespace twinbench::campaign
