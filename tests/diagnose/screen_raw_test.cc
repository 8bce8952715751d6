#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "tests/diagnose/support/synthetic_run.h"
#include "twin/core/stream.h"
#include "twin/core/units.h"

namespace twinbench::diagnose {
namespace {

constexpr double kRate_hz = 5000.0;
constexpr int kScans = 500;     // 0.1 s
constexpr double kNoise = 8.0;  // codes
const RawScale kScale = {{"a", "b"}, kRate_hz, 0.15e-6};

/// 40 blocks of two channels: a level of its own each, noise, and `signal` (codes) on channel "a".
std::vector<RawBlock> Blocks(std::uint64_t seed, const std::function<double(int block, double time_s)>& signal) {
  Stream stream(seed, "test.raw");
  std::vector<RawBlock> blocks;
  for (int b = 0; b < 40; ++b) {
    RawBlock block{b, 2, {}};
    const double level = 400.0 * (stream.Uniform() - 0.5);
    for (int i = 0; i < kScans; ++i) {
      for (int c = 0; c < 2; ++c) {
        const double code = level + kNoise * stream.Normal() + (c == 0 ? signal(b, i / kRate_hz) : 0.0);
        block.samples.push_back(static_cast<std::int16_t>(std::lround(code)));
      }
    }
    blocks.push_back(block);
  }
  return blocks;
}

double Silence(int, double) {
  return 0.0;
}

TEST(ScreenRaw, FindsHumWhosePhaseIsDifferentInEachBlock) {
  // 0.8 codes in noise of 8: invisible in one sample, 2.2 s.d. a block, certain in 40.
  const auto tests =
      ScreenRaw(Blocks(1, [](int b, double t) { return 0.8 * std::sin(2 * units::kPi * 60.0 * t + b); }), kScale);
  const ScreenTest* hum = Find(tests, "raw: hum");
  ASSERT_NE(hum, nullptr);
  EXPECT_LT(hum->p, 0.01);
  EXPECT_NE(hum->reading.find("60 Hz on a"), std::string::npos) << hum->reading;
  // Amplitude from power over the floor: standard uncertainty 0.06 codes of 0.15 um.
  EXPECT_NEAR(hum->effect_m / kScale.code_SI, 0.8, 0.2);
}

TEST(ScreenRaw, FindsARingDownWithItsFrequency) {
  const auto ring = [](int b, double t) {
    return 6.0 * std::exp(-t / 0.02) * std::cos(2 * units::kPi * 140.0 * t + b);
  };
  const auto tests = ScreenRaw(Blocks(1, ring), kScale);
  const ScreenTest* found = Find(tests, "raw: ring-down");
  ASSERT_NE(found, nullptr);
  EXPECT_LT(found->p, 0.01);
  EXPECT_NE(found->reading.find("a at 140 Hz"), std::string::npos) << found->reading;
}

TEST(ScreenRaw, FindsACodeThatNeverComes) {
  auto blocks = Blocks(1, Silence);
  for (RawBlock& block : blocks) {
    for (std::size_t i = 1; i < block.samples.size(); i += 2)
      block.samples[i] = static_cast<std::int16_t>(block.samples[i] + (block.samples[i] == 64));
  }
  // 20000 samples over some 400 codes: 50 each, missing in one place: 7 standard deviations.
  const auto tests = ScreenRaw(blocks, kScale);
  const ScreenTest* codes = Find(tests, "raw: code density");
  ASSERT_NE(codes, nullptr);
  EXPECT_LT(codes->p, 0.01);
  EXPECT_NE(codes->reading.find("of b"), std::string::npos) << codes->reading;
  bool listed = false;
  for (const std::string& line : codes->tables) listed = listed || line.find("code 64 of b") != std::string::npos;
  EXPECT_TRUE(listed);
}

TEST(ScreenRaw, SeldomSpeaksOfSilentBlocks) {
  int loud = 0, all = 0;
  for (std::uint64_t seed = 10; seed < 30; ++seed) {
    for (const ScreenTest& t : ScreenRaw(Blocks(seed, Silence), kScale, 100, seed)) {
      loud += t.p < 0.05;
      ++all;
    }
  }
  EXPECT_EQ(all, 60);
  // 3 by chance; more than 9 has probability 0.001.
  EXPECT_LE(loud, 9);
}

TEST(ScreenRaw, LeavesOutWhatTheBlocksAreTooShortFor) {
  std::vector<RawBlock> blocks = Blocks(1, Silence);
  for (RawBlock& b : blocks) b.samples.resize(2 * 10);  // 2 ms
  EXPECT_EQ(Find(ScreenRaw(blocks, kScale), "raw: hum"), nullptr);
  EXPECT_TRUE(ScreenRaw({}, kScale).empty());
}

}  // namespace
}  // namespace twinbench::diagnose
