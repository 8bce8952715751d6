#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "tests/diagnose/support/synthetic_run.h"
#include "tests/support/night.h"
#include "tests/support/rotary_scenario.h"
#include "twin/benches/rotary_4dof/bench.h"
#include "twin/benches/rotary_4dof/diagnosis/rotary_run.h"
#include "twin/benches/rotary_4dof/procedure/procedure.h"
#include "twin/benches/rotary_4dof/settings.h"
#include "twin/benches/rotary_4dof/twin/factory.h"
#include "twin/benches/rotary_4dof/twin/twin.h"
#include "twin/core/effect_catalogue.h"
#include "twin/core/scenario.h"
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
  const ScreenTest hum = Loud(tests, "raw: hum", 0.01, "60 Hz on a");
  // Amplitude from power over the floor: standard uncertainty 0.06 codes of 0.15 um.
  EXPECT_NEAR(hum.effect_m / kCode_m, 0.8, 0.2);
}

TEST(ScreenRaw, FindsARingDownWithItsFrequency) {
  const auto ring = [](int b, double t) {
    return 6.0 * std::exp(-t / 0.02) * std::cos(2 * units::kPi * 140.0 * t + b);
  };
  Loud(ScreenRaw(Blocks(1, ring), kScale), "raw: ring-down", 0.01, "a at 140 Hz");
}

TEST(ScreenRaw, FindsACodeThatNeverComes) {
  auto blocks = Blocks(1, Silence);
  for (RawBlock& block : blocks) {
    for (std::size_t i = 1; i < block.samples.size(); i += 2)
      block.samples[i] = static_cast<std::int16_t>(block.samples[i] + (block.samples[i] == 64));
  }
  // 20000 samples over some 400 codes: 50 each, missing in one place: 7 standard deviations.
  const ScreenTest codes = Loud(ScreenRaw(blocks, kScale), "raw: code density", 0.01, "of b");
  EXPECT_THAT(codes.tables, testing::Contains(testing::HasSubstr("code 64 of b")));
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
  const auto sixty = ScreenRaw(Blocks(1, hum(60.0)), slow), fifty = ScreenRaw(Blocks(1, hum(50.0)), slow);
  EXPECT_NEAR(Loud(sixty, "raw: hum", 0.01, "60 Hz (seen at 10 Hz) on a").effect_m / kCode_m, 0.8, 0.2);
  Loud(fifty, "raw: hum", 0.01, "50 or 120 Hz (seen at 20 Hz)");
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
  // 20000 samples: a share of 0.08 is 8 standard deviations, a memory of 0.1 is 10.
  Loud(ScreenRaw(ghost, kScale), "raw: settling", 0.001, "of a stays in b");
  Loud(ScreenRaw(memory, kScale), "raw: settling", 0.001, "of the sample before stays in a");
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
  Loud(ScreenRaw(Blocks(1, wander), kScale), "raw: Allan deviation", 0.001, "of a ");
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

/// Raw blocks as the twin's converter makes them.

class RawSink : public ReadingSink {
 public:
  void Append(const Reading& reading, const Acquisition& block) override {
    readings.push_back(reading);
    if (!block.raw.empty()) blocks.push_back({reading.reading, kChannels, block.raw});
  }
  std::vector<Reading> readings;
  std::vector<RawBlock> blocks;
};

/// A short run that keeps its raw codes. Both tables wobble, so that the spots visit a few hundred codes.
Scenario SmallBench(std::uint64_t seed, int samples) {
  Scenario scenario = twinbench::test::RotaryScenario();
  scenario.seed = seed;
  RotaryOf(scenario).procedure.positions = 12;
  RotaryOf(scenario).adc.samples = samples;
  RotaryOf(scenario).procedure.shifts = {0, 1, 5};
  RotaryOf(scenario).procedure.passes = {1, -1};
  RotaryOf(scenario).procedure.keep_raw = true;
  for (TableSettings* table : {&RotaryOf(scenario).target, &RotaryOf(scenario).reference}) {
    for (int c = 0; c < kComponents; ++c) {
      table->random_rms[static_cast<std::size_t>(c)] =
          IsAngle(static_cast<Component>(c)) ? 2.0 * units::arcsec : 1.0 * units::um;
    }
  }
  return scenario;
}

std::vector<ScreenTest> ScreenOf(const Scenario& actual, const Scenario& believed) {
  sim::Twin twin(actual);
  RotaryBench bench = twin.Bench();
  RawSink sink;
  procedure::CarryOut(bench, actual, sink);
  const rotary::RotaryRun rotary = rotary::BuildRun(sink.readings, believed, {benches::rotary::FollowRecord});
  return ScreenRaw(sink.blocks, benches::rotary::RawScaleOf(believed, rotary.run), 200, actual.seed);
}

TEST(ScreenOfTheTwin, FindsTheMainsHumOfTheAmplifierWithItsAmplitude) {
  Scenario actual = SmallBench(1, 2500);  // 40 ms: two periods
  const Scenario believed = actual;
  RotaryOf(actual).amplifier.hum_V = 0.5 * units::mV;
  const ScreenTest hum = Loud(ScreenOf(actual, believed), "raw: hum", 1e-6, "a wave of 50 Hz");
  // 0.5 mV at 2000 V/m; 6 mV of noise in 98 blocks of 2500: standard uncertainty 0.5 %, and the largest of four.
  EXPECT_NEAR(hum.effect_m, 0.25 * units::um, 0.03 * units::um);
}

TEST(ScreenOfTheTwin, FindsAMissingCodeOfTheConverter) {
  Scenario actual = SmallBench(1, 1000);
  const Scenario believed = actual;
  const double code_V = 20.0 / 65536.0;
  actual.effects.push_back({"adc_step", "psd_a_y", {{"step", code_V}, {"at_voltage", 20.5 * code_V}}, "test"});
  const ScreenTest codes = Loud(ScreenOf(actual, believed), "raw: code density", 1e-6, "code 21 of psd_a_y");
  EXPECT_THAT(codes.reading, testing::HasSubstr("(missing)"));
}

TEST(ScreenOfTheTwin, FindsTheGhostOfTheChannelScannedBefore) {
  Scenario actual = SmallBench(1, 1000);
  const Scenario believed = actual;
  actual.effects.push_back({"crosstalk", "psd_b_x", {{"fraction", 0.05}}, "test"});
  // 98 blocks of 1000 scans: 0.05 is 11 standard deviations.
  Loud(ScreenOf(actual, believed), "raw: settling", 1e-6, "of psd_a_y stays in psd_b_x");
}

TEST(ScreenOfTheTwin, TellsNothingOfCleanBlocksButAtTheStatedRate) {
  const int runs = twinbench::test::ByNight(40, 10);
  int told = 0;
  for (std::uint64_t seed = 1; seed <= static_cast<std::uint64_t>(runs); ++seed) {
    const Scenario clean = SmallBench(seed, 1500);
    const auto tests = ScreenOf(clean, clean);
    EXPECT_EQ(tests.size(), 5u);
    told += !Loud(tests).empty();
  }
  // At 1 in 100: 4 or more of 40 have probability 0.001, 3 or more of 10 1e-4.
  EXPECT_LE(told, runs == 40 ? 3 : 2);
}

}  // namespace
}  // namespace twinbench::diagnose
