#pragma once

#include <gtest/gtest.h>

#include "twin/sim/ad_sampler.h"

/// Blocks of the twin's converter, for tests of what is looked for in them.
namespace twinbench::test {

inline constexpr double kNoise_V = 6e-3;  // of the reference bench
inline const double kLsb_V = sim::LsbOf({});

/// Four channels far enough apart to be told from each other, with the noise of the reference bench.
inline sim::AdInput FourLevels(double noise_V) {
  sim::AdInput input;
  constexpr std::array<double, kChannels> kLevels_V = {0.4, -1.3, 2.1, 0.05};
  for (std::size_t k = 0; k < kChannels; ++k) {
    input.channel[k].level_V = kLevels_V[k];
    input.channel[k].noise_V = noise_V;
  }
  return input;
}

inline std::vector<std::int16_t> RawBlock(const sim::AdInput& input, int scans, std::uint64_t seed,
                                          const AdcSettings& adc = {}) {
  Stream noise(seed, "test.block");
  return sim::TakeBlock(adc, input, {.n_samples = scans, .keep_raw = true}, noise).raw;
}

/// From word `word` on every word is the next one.
inline void LoseAWord(std::vector<std::int16_t>& raw, std::size_t word) {
  raw.erase(raw.begin() + static_cast<std::ptrdiff_t>(word));
  raw.push_back(raw[raw.size() - kChannels]);  // as the next scan would begin
}

/// Everything but the stamp, which the twin has none of; numbers bit for bit, and NaN equals NaN.
inline void ExpectSameBlock(const Acquisition& a, const Acquisition& b) {
  EXPECT_EQ(a.start, b.start);
  EXPECT_EQ(a.status, b.status);
  EXPECT_EQ(a.n_samples, b.n_samples);
  EXPECT_EQ(a.saturated_mask, b.saturated_mask);
  if (!b.raw.empty()) {
    EXPECT_EQ(a.raw, b.raw);
  }
  for (std::size_t k = 0; k < kChannels; ++k) {
    for (const auto number :
         {&ChannelBlock::mean_V, &ChannelBlock::std_V, &ChannelBlock::min_V, &ChannelBlock::max_V})
      EXPECT_EQ(std::bit_cast<std::uint64_t>(a.channel[k].*number),
                std::bit_cast<std::uint64_t>(b.channel[k].*number))
          << "channel " << k << ": " << a.channel[k].*number << " and " << b.channel[k].*number;
  }
}

}  // namespace twinbench::test
