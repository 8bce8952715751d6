#include "hw_bridge/ad/volts.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/hw_ad/blocks.h"
#include "twin/core/block_statistics.h"

namespace twinbench::hw {
namespace {

TEST(Volts, AreThePolynomialAboutItsOrigin) {
  const CalibrationPolynomial cubic{2.0, {1.0, 0.5, -0.25, 0.125}};
  EXPECT_DOUBLE_EQ(VoltsOf(5.0, cubic), 1.0 + 0.5 * 3.0 - 0.25 * 9.0 + 0.125 * 27.0);
}

TEST(Volts, OfALinearCalibrationAreThoseOfTheCodesScaled) {
  const auto raw = test::RawBlock(test::FourLevels(6e-3), 1000, 1);
  const double lsb_V = sim::LsbOf({});
  const ChannelBlock calibrated = CalibratedStatistics(raw, 2, {-7.0, {0.1, 1.01 * lsb_V}});
  const ChannelBlock plain = StatisticsOf(MomentsOf(raw, kChannels, 2), lsb_V);
  // Sums of a thousand doubles.
  EXPECT_NEAR(calibrated.mean_V, 0.1 + 1.01 * (plain.mean_V + 7.0 * lsb_V), 1e-12);
  EXPECT_NEAR(calibrated.std_V, 1.01 * plain.std_V, 1e-12);
  EXPECT_NEAR(calibrated.min_V, 0.1 + 1.01 * (plain.min_V + 7.0 * lsb_V), 1e-12);
  EXPECT_NEAR(calibrated.max_V, 0.1 + 1.01 * (plain.max_V + 7.0 * lsb_V), 1e-12);
}

TEST(Volts, OfOneSampleHaveNoDeviation) {
  const std::vector<std::int16_t> raw = {1, 2, 3, 4};
  EXPECT_TRUE(std::isnan(CalibratedStatistics(raw, 0, {0.0, {0.0, 1.0}}).std_V));
}

}  // namespace
}  // namespace twinbench::hw
