#include "hw_bridge/ad/lost_word.h"

#include <gtest/gtest.h>

#include <cmath>

#include "hw_bridge/ad/channel_slip.h"
#include "tests/hw_ad/blocks.h"

namespace twinbench::hw {
namespace {

using test::kLsb_V, test::kNoise_V;

constexpr std::array<std::size_t, kChannels> kAsWired = {0, 1, 2, 3};
constexpr double kOneInABillion = 1e-9;
const double kSampleNoise_lsb = kNoise_V / kLsb_V;

/// One channel of which is that far from the three others.
std::array<double, kChannels> Apart(double by_lsb) {
  return {by_lsb, 0.0, 0.0, 0.0};
}

/// How many of 300 blocks of so many scans show the word that they lost in their middle.
int Seen(double apart_lsb, int scans) {
  sim::AdInput input = test::FourLevels(kNoise_V);
  for (std::size_t k = 0; k < kChannels; ++k) input.channel[k].level_V = Apart(apart_lsb)[k] * kLsb_V;
  int seen = 0;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    auto raw = test::RawBlock(input, scans, seed);
    test::LoseAWord(raw, static_cast<std::size_t>(2 * scans));
    seen += FindChannelSlip(raw, kAsWired, kSampleNoise_lsb, kOneInABillion).places == 1 ? 1 : 0;
  }
  return seen;
}

/// The closest that a channel may be to the others, by bisection of the closed form.
double Limit_lsb(int scans) {
  double hidden_lsb = 0.0, shown_lsb = 1e4;
  for (int halving = 0; halving < 50; ++halving) {
    const double apart_lsb = 0.5 * (hidden_lsb + shown_lsb);
    const bool shows = IfAWordWereLost(Apart(apart_lsb), kAsWired, kSampleNoise_lsb, scans, kOneInABillion).shows;
    (shows ? shown_lsb : hidden_lsb) = apart_lsb;
  }
  return shown_lsb;
}

TEST(LostWord, IsSeenWhereItIsSaidToBeAndNotMuchBelow) {
  for (const int scans : {100, 1000}) {
    const double limit_lsb = Limit_lsb(scans);
    EXPECT_GE(Seen(limit_lsb, scans), 296) << limit_lsb << ": 3 standard deviations leave 0.4 of 300 out";
    EXPECT_LE(Seen(0.5 * limit_lsb, scans), 30) << "D/4 is 30, 53 and more are asked for, its deviation is 11";
  }
}

TEST(LostWord, ShiftsAMeanByHalfOfWhatTheLevelsDiffer) {
  EXPECT_EQ(IfAWordWereLost({5.0, 11.0, 9.0, 2.0}, kAsWired, 20.0, 100, kOneInABillion).shift_lsb, 3.5) << "9 to 2";
  EXPECT_EQ(IfAWordWereLost({5.0, 11.0, 9.0, 2.0}, {0, 2, 1, 3}, 20.0, 100, kOneInABillion).shift_lsb, 4.5)
      << "11 to 2";
}

TEST(LostWord, IsHiddenAmongLevelsThatDifferByLessThanFourCodesWhateverTheirNoise) {
  EXPECT_FALSE(IfAWordWereLost(Apart(3.9), kAsWired, 0.3, 10000, kOneInABillion).shows);
  EXPECT_TRUE(IfAWordWereLost(Apart(4.1), kAsWired, 0.3, 10000, kOneInABillion).shows);
}

}  // namespace
}  // namespace twinbench::hw
