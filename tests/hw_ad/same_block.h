#pragma once

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>

#include "twin/core/devices.h"

namespace twinbench::test {

/// Bit for bit; NaN equals NaN.
inline void ExpectSameBits(double a, double b) {
  EXPECT_EQ(std::bit_cast<std::uint64_t>(a), std::bit_cast<std::uint64_t>(b)) << a << " and " << b;
}

/// Everything but the stamp, which the twin has none of.
inline void ExpectSameBlock(const Acquisition& a, const Acquisition& b) {
  EXPECT_EQ(a.start, b.start);
  EXPECT_EQ(a.status, b.status);
  EXPECT_EQ(a.n_samples, b.n_samples);
  EXPECT_EQ(a.saturated_mask, b.saturated_mask);
  if (!b.raw.empty()) {
    EXPECT_EQ(a.raw, b.raw);
  }
  for (std::size_t k = 0; k < kChannels; ++k) {
    ExpectSameBits(a.channel[k].mean_V, b.channel[k].mean_V);
    ExpectSameBits(a.channel[k].std_V, b.channel[k].std_V);
    ExpectSameBits(a.channel[k].min_V, b.channel[k].min_V);
    ExpectSameBits(a.channel[k].max_V, b.channel[k].max_V);
  }
}

}  // namespace twinbench::test
