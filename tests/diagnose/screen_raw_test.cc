#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "tests/diagnose/support/synthetic_run.h"
#include "twin/benches/rotary_4dof/bench.h"
#include "twin/benches/rotary_4dof/settings.h"
#include "twin/core/stream.h"
#include "twin/core/units.h"

namespace twinbench::diagnose {
namespace {

constexpr double kRate_Hz = 5000.0;
constexpr double kCode_m = 0.15e-6;
constexpr int kScans = 500;     // 0.1 s
constexpr double kNoise = 8.0;  // codes
const RawScale kScale = {{{"a", kCode_m, kCode_m / 0.2}, {"b", kCode_m, kCode_m / 0.2}}, {0, 1}, kRate_Hz};

/// 40 blocks of two channels: a level of its own each, noise, and `signal` (codes) on channel "a".
std::vector<RawBlock> Blocks(std::uint64_t seed, const std::function<double(int block, double time_s)>& signal) {
  Stream stream(seed, "test.raw");
  std::vector<RawBlock> blocks;
  for (int b = 0; b < 40; ++b) {
    RawBlock block{b, 2, {}};
    const double level = 400.0 * (stream.Uniform() - 0.5);
    for (int i = 0; i < kScans; ++i) {
      for (int c = 0; c < 2; ++c) {
        const double code = level + kNoise * stream.Normal() + (c == 0 ? signal(b, i / kRate_Hz) : 0.0);
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
  EXPECT_NEAR(hum->effect_m / kCode_m, 0.8, 0.2);
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
  EXPECT_EQ(all, 100);
  // 5 by chance; more than 12 has probability 0.001.
  EXPECT_LE(loud, 12);
}

TEST(ScreenRaw, LeavesOutWhatTheBlocksAreTooShortFor) {
  std::vector<RawBlock> blocks = Blocks(1, Silence);
  for (RawBlock& b : blocks) b.samples.resize(2 * 10);  // 2 ms
  EXPECT_EQ(Find(ScreenRaw(blocks, kScale), "raw: hum"), nullptr);
  EXPECT_TRUE(ScreenRaw({}, kScale).empty());
}

TEST(ScreenRaw, FindsHumThatSlowSamplingFoldsToAnotherFrequency) {
  RawScale slow = kScale;
  slow.scan_rate_Hz = 70.0;
  // Samples come kRate_Hz / 70 times later than Blocks believes. 60 Hz in 70 Hz: 10 Hz; 50 and 120 both show at 20.
  const auto hum = [](double Hz) {
    return [Hz](int b, double t) { return 0.8 * std::sin(2 * units::kPi * Hz * t * kRate_Hz / 70.0 + b); };
  };
  const auto sixty = ScreenRaw(Blocks(1, hum(60.0)), slow);
  ASSERT_NE(Find(sixty, "raw: hum"), nullptr);
  EXPECT_LT(Find(sixty, "raw: hum")->p, 0.01);
  EXPECT_NE(Find(sixty, "raw: hum")->reading.find("60 Hz (seen at 10 Hz) on a"), std::string::npos);
  EXPECT_NEAR(Find(sixty, "raw: hum")->effect_m / kCode_m, 0.8, 0.2);
  const auto fifty = ScreenRaw(Blocks(1, hum(50.0)), slow);
  EXPECT_NE(Find(fifty, "raw: hum")->reading.find("50 or 120 Hz (seen at 20 Hz)"), std::string::npos);
}

TEST(ScreenRaw, TellsWhatTheMultiplexerKeepsFromWhatTheAmplifierKeeps) {
  auto ghost = Blocks(1, Silence), memory = Blocks(2, Silence);
  for (RawBlock& block : ghost) {
    for (std::size_t i = 1; i < block.samples.size(); i += 2)
      block.samples[i] = static_cast<std::int16_t>(std::lround(block.samples[i] + 0.08 * block.samples[i - 1]));
  }
  for (RawBlock& block : memory) {
    for (std::size_t i = 2; i < block.samples.size(); i += 2)
      block.samples[i] =
          static_cast<std::int16_t>(std::lround(0.9 * block.samples[i] + 0.1 * block.samples[i - 2]));
  }
  const auto of_ghost = ScreenRaw(ghost, kScale), of_memory = ScreenRaw(memory, kScale);
  const ScreenTest *kept = Find(of_ghost, "raw: settling"), *slow = Find(of_memory, "raw: settling");
  ASSERT_NE(kept, nullptr);
  ASSERT_NE(slow, nullptr);
  // 20000 samples: a share of 0.08 is 8 standard deviations, a memory of 0.1 is 10.
  EXPECT_LT(kept->p, 0.001);
  EXPECT_NE(kept->reading.find("of a stays in b"), std::string::npos) << kept->reading;
  EXPECT_LT(slow->p, 0.001);
  EXPECT_NE(slow->reading.find("of the sample before stays in a"), std::string::npos) << slow->reading;
}

TEST(ScreenRaw, DoesNotTakeHumForSettling) {
  const auto tests =
      ScreenRaw(Blocks(3, [](int b, double t) { return 8.0 * std::sin(2 * units::kPi * 50.0 * t + b); }), kScale);
  EXPECT_LT(Find(tests, "raw: hum")->p, 1e-6);
  EXPECT_GT(Find(tests, "raw: settling")->p, 0.005);
}

TEST(ScreenRaw, FindsARandomWalkThatAveragingDoesNotRemove) {
  Stream steps(4, "test.walk");
  double walk = 0.0;
  const auto wander = [&](int, double t) { return walk = t == 0.0 ? 0.0 : walk + 0.5 * steps.Normal(); };
  const auto tests = ScreenRaw(Blocks(1, wander), kScale);
  const ScreenTest* allan = Find(tests, "raw: Allan deviation");
  ASSERT_NE(allan, nullptr);
  EXPECT_LT(allan->p, 0.001);
  EXPECT_NE(allan->reading.find("of a "), std::string::npos) << allan->reading;
}

TEST(ScreenRaw, SaysThatBlocksOfLessThanAPeriodCannotShowTheMains) {
  std::vector<RawBlock> blocks = Blocks(1, Silence);
  EXPECT_TRUE(RawLimitsInWords(blocks, kScale).empty());
  for (RawBlock& b : blocks) b.samples.resize(2 * 50);  // 10 ms
  EXPECT_NE(RawLimitsInWords(blocks, kScale).find("10 ms"), std::string::npos);
}

TEST(RawScale, GivesACodeAsALengthOnThePsdAndAsTheRotationThatMovesItsAxis) {
  Scenario scenario;  // 16 bit over +-10 V
  RotaryOf(scenario).psd_a.sensitivity_V_m = 2000.0;
  RotaryOf(scenario).psd_b.sensitivity_V_m = 1000.0;
  const RawScale scale =
      benches::rotary::RawScaleOf(scenario, SyntheticRun({}));  // yaw and tilt show 0.2 m a radian
  ASSERT_EQ(scale.channels.size(), 4u);
  EXPECT_DOUBLE_EQ(scale.channels[0].code_SI, 20.0 / 65536.0 / 2000.0);
  EXPECT_DOUBLE_EQ(scale.channels[3].code_SI, 20.0 / 65536.0 / 1000.0);
  EXPECT_DOUBLE_EQ(scale.channels[0].code_rad, scale.channels[0].code_SI / 0.2);
  EXPECT_DOUBLE_EQ(scale.scan_rate_Hz, RotaryOf(scenario).adc.rate_Hz / 4.0);
}

}  // namespace
}  // namespace twinbench::diagnose
