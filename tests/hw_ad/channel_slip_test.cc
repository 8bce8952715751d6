#include "hw_bridge/ad/channel_slip.h"
#include "hw_bridge/ad/lost_word.h"
#include "tests/hw_ad/blocks.h"

namespace twinbench::hw {
namespace {

using test::FourLevels, test::kLsb_V, test::kNoise_V, test::LoseAWord, test::RawBlock;

constexpr double kFalseAlarms = 1e-9;
constexpr std::array<std::size_t, kChannels> kInOrder = {0, 1, 2, 3};
const double kNoise_lsb = kNoise_V / kLsb_V;

ChannelSlip Find(const std::vector<std::int16_t>& raw) {
  return FindChannelSlip(raw, kInOrder, kNoise_lsb, kFalseAlarms);
}

TEST(ChannelSlip, IsFoundWhereverTheWordWasLost) {
  for (std::size_t word = 4 * 5; word < 4 * 95; ++word) {
    auto raw = RawBlock(FourLevels(kNoise_V), 100, word);
    LoseAWord(raw, word);
    const ChannelSlip slip = Find(raw);
    EXPECT_EQ(slip.places, 1) << word;
    EXPECT_NEAR(slip.scan, static_cast<int>(word / 4), 1) << "the scan of the change is mixed";
  }
}

TEST(ChannelSlip, IsFoundForEveryNumberOfLostWordsAndInABlockOfManySeconds) {
  for (int words = 1; words < kChannels; ++words) {
    auto block = RawBlock(FourLevels(kNoise_V), 100, 1);
    for (int k = 0; k < words; ++k) LoseAWord(block, 160);
    EXPECT_EQ(Find(block).places, words);
  }
  auto raw = RawBlock(FourLevels(kNoise_V), 350000, 1);
  EXPECT_EQ(Find(raw).scan, -1);
  LoseAWord(raw, 4 * 200001 + 2);
  EXPECT_EQ(Find(raw).places, 1);
  EXPECT_NEAR(Find(raw).scan, 200001, 4) << "looked for every 4 scans";
}

TEST(ChannelSlip, IsFoundBetweenLevelsThatDifferByLessThanTheNoise) {
  // Steps of 10 codes under 20 codes of noise, 1000 scans: the likelihood ratio is 2000 against the 59 that are
  // needed.
  sim::AdInput input = FourLevels(kNoise_V);
  for (std::size_t k = 0; k < kChannels; ++k) input.channel[k].level_V = 10.0 * static_cast<double>(k) * kLsb_V;
  int found = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    auto raw = RawBlock(input, 1000, seed);
    LoseAWord(raw, 2000);
    found += Find(raw).places == 1 ? 1 : 0;
  }
  EXPECT_EQ(found, 200);
}

TEST(ChannelSlip, IsFoundUnderHum) {
  sim::AdInput input = FourLevels(kNoise_V);
  input.hum = {0.5, 50.0, 0.0};
  for (const int scans : {100, 5000}) {
    auto raw = RawBlock(input, scans, 1);
    LoseAWord(raw, static_cast<std::size_t>(2 * scans));
    EXPECT_EQ(Find(raw).places, 1) << scans;
  }
}

TEST(ChannelSlip, IsFoundInTheOrderOfTheScanNotOfTheChannels) {
  const std::array<std::size_t, kChannels> order = {2, 0, 3, 1};
  auto scanned = RawBlock(FourLevels(kNoise_V), 100, 1);
  LoseAWord(scanned, 200);
  std::vector<std::int16_t> raw(scanned.size());
  for (std::size_t i = 0; i < raw.size(); ++i) raw[i / 4 * 4 + order[i % 4]] = scanned[i];
  EXPECT_EQ(FindChannelSlip(raw, order, kNoise_lsb, kFalseAlarms).places, 1);
}

/// A block with `change(scan, channel)` volts added.
template <class Change>
std::vector<std::int16_t> Changed(int scans, std::uint64_t seed, const Change& change) {
  auto raw = RawBlock(FourLevels(kNoise_V), scans, seed);
  for (std::size_t i = 0; i < raw.size(); ++i) {
    const double volts = change(static_cast<int>(i / 4), static_cast<int>(i % 4));
    raw[i] = static_cast<std::int16_t>(raw[i] + std::lround(volts / kLsb_V));
  }
  return raw;
}

TEST(ChannelSlip, IsNotSeenInTheStepOfOneChannelOrOfAPsd) {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    const double step_V = 0.01 * static_cast<double>(seed + 1);
    const int at = static_cast<int>(seed) % 90 + 5;
    const auto one = [&](int scan, int channel) { return scan >= at && channel == 2 ? step_V : 0.0; };
    const auto two = [&](int scan, int channel) { return scan >= at && channel < 2 ? step_V : 0.0; };
    EXPECT_EQ(Find(Changed(100, seed, one)).scan, -1) << seed;
    EXPECT_EQ(Find(Changed(100, seed, two)).scan, -1) << seed;
  }
}

TEST(ChannelSlip, IsNotSeenWhereSpotsCrossTheirCentresTogether) {
  // The x of both PSDs from -1 V to +1 V with y at 0: the means of the halves are each other's turned ones.
  sim::AdInput input = FourLevels(kNoise_V);
  for (std::size_t k = 0; k < kChannels; ++k) {
    input.channel[k].level_V = k % 2 == 0 ? -1.0 : 0.0;
    input.channel[k].slope_V_s = k % 2 == 0 ? 2.0 / 1.6e-3 : 0.0;
  }
  for (std::uint64_t seed = 0; seed < 300; ++seed) EXPECT_EQ(Find(RawBlock(input, 100, seed)).scan, -1);
}

TEST(ChannelSlip, IsNotSeenInASpikeOfOneScanNorInAFlickeringLastDigit) {
  sim::AdInput input = FourLevels(kNoise_V);
  for (auto& channel : input.channel) channel.level_V = 0.3;
  auto raw = RawBlock(input, 100, 1);
  for (int k = 0; k < kChannels; ++k) raw[200 + k] = static_cast<std::int16_t>(5000 * k);
  EXPECT_EQ(Find(raw).scan, -1);
  // Noise far below a code: channels that flip together by one.
  std::vector<std::int16_t> flickering;
  for (int scan = 0; scan < 100; ++scan) {
    const auto flip = static_cast<std::int16_t>(scan >= 50);
    flickering.insert(flickering.end(), {0, 0, flip, static_cast<std::int16_t>(1 - flip)});
  }
  EXPECT_EQ(FindChannelSlip(flickering, kInOrder, 0.289, kFalseAlarms).scan, -1);
}

/// One channel of which is that far from the three others.
std::array<double, kChannels> Apart(double by_lsb) { return {by_lsb, 0.0, 0.0, 0.0}; }

/// How many of 300 blocks of so many scans show the word that they lost in their middle.
int Seen(double apart_lsb, int scans) {
  sim::AdInput input = FourLevels(kNoise_V);
  for (std::size_t k = 0; k < kChannels; ++k) input.channel[k].level_V = Apart(apart_lsb)[k] * kLsb_V;
  int seen = 0;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    auto raw = RawBlock(input, scans, seed);
    LoseAWord(raw, static_cast<std::size_t>(2 * scans));
    seen += Find(raw).places == 1 ? 1 : 0;
  }
  return seen;
}

/// The closest that a channel may be to the others, by bisection of the closed form.
double Limit_lsb(int scans) {
  double hidden_lsb = 0.0, shown_lsb = 1e4;
  for (int halving = 0; halving < 50; ++halving) {
    const double apart_lsb = 0.5 * (hidden_lsb + shown_lsb);
    const bool shows = IfAWordWereLost(Apart(apart_lsb), kInOrder, kNoise_lsb, scans, kFalseAlarms).shows;
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
  EXPECT_EQ(IfAWordWereLost({5.0, 11.0, 9.0, 2.0}, kInOrder, 20.0, 100, kFalseAlarms).shift_lsb, 3.5) << "9 to 2";
  EXPECT_EQ(IfAWordWereLost({5.0, 11.0, 9.0, 2.0}, {0, 2, 1, 3}, 20.0, 100, kFalseAlarms).shift_lsb, 4.5)
      << "11 to 2";
}

TEST(LostWord, IsHiddenAmongLevelsThatDifferByLessThanFourCodesWhateverTheirNoise) {
  EXPECT_FALSE(IfAWordWereLost(Apart(3.9), kInOrder, 0.3, 10000, kFalseAlarms).shows);
  EXPECT_TRUE(IfAWordWereLost(Apart(4.1), kInOrder, 0.3, 10000, kFalseAlarms).shows);
}

}  // namespace
}  // namespace twinbench::hw
