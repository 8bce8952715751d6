#include "twin/sim/low_pass.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/sim/follow_key.h"
#include "tests/sim/quiet_scenario.h"
#include "twin/benches/rotary_4dof/twin/twin.h"

namespace twinbench::sim {
namespace {

constexpr double kStep_s = 4e-6;

// An edge that takes one knot's distance h is followed by 1 - (lag / h) (1 - exp(-h / lag)) exp(-t / lag).
TEST(LowPass, FollowsAStepExponentially) {
  BlockCourse edge(FromSeconds(kStep_s));
  for (int k = 0; k <= 1000; ++k) edge.Add({k < 600 ? 0.0 : 1.0, 0.0, 2.0, k < 600 ? 0.0 : -3.0});
  const LowPass low_pass(2000.0);
  const double lag_s = 1.0 / (units::turn * 2000.0);
  const BlockCourse passed = low_pass.Passed(edge, FromSeconds(kStep_s), 1000);
  for (int k = 600; k <= 1000; k += 20) {
    const double left =
        lag_s / kStep_s * (1.0 - std::exp(-kStep_s / lag_s)) * std::exp(-(k - 600) * kStep_s / lag_s);
    EXPECT_NEAR(passed.At_V(0, k * kStep_s), 1.0 - left, 1e-9) << k;
    EXPECT_NEAR(passed.At_V(3, k * kStep_s), -3.0 * (1.0 - left), 1e-9) << k;
  }
  EXPECT_NEAR(passed.At_V(0, 0.0), 0.0, 1e-12);  // the edge is 30 lags away
  EXPECT_NEAR(passed.At_V(2, 1e-3), 2.0, 1e-12);
}

TEST(LowPass, IsOneLagBehindARamp) {
  BlockCourse ramp(FromSeconds(kStep_s));
  for (int k = 0; k <= 100; ++k) ramp.Add({5.0 * k * kStep_s, 0.0, 0.0, 0.0});
  const LowPass low_pass(500.0);
  const BlockCourse passed = low_pass.Passed(ramp, FromSeconds(kStep_s), 100);
  for (const double t_s : {0.0, 1e-4, 4e-4})
    EXPECT_NEAR(passed.At_V(0, t_s), 5.0 * (t_s - low_pass.Lag_s()), 1e-9) << t_s;
}

double ToneAmplitude_V(double frequency_Hz, double low_pass_Hz) {
  Scenario scenario = Quiet();
  scenario.effects.push_back(
      {"tone", "all", {{"amplitude", 1e-6}, {"frequency", frequency_Hz}, {"phase", 0.4}}, "test"});
  RotaryOf(scenario).chain.low_pass_Hz = low_pass_Hz;
  return std::sqrt(2.0) * Twin(scenario).Bench().adc.Acquire(5000, false).channel[1].std_V;
}

TEST(LowPass, AttenuatesATone) {
  for (const double frequency_Hz : {400.0, 2000.0, 8000.0}) {
    const double expected = 1.0 / std::hypot(1.0, frequency_Hz / 2000.0);
    // Cubics through the knots miss 6e-4 of a sine, straight lines between conversions 4e-3 at 8 kHz.
    EXPECT_NEAR(ToneAmplitude_V(frequency_Hz, 2000.0) / ToneAmplitude_V(frequency_Hz, 0.0), expected,
                0.01 * expected)
        << frequency_Hz << " Hz";
  }
}

Scenario OnlyTheLightsNoise(double low_pass_Hz) {
  Scenario scenario = Quiet();
  scenario.noise_free = false;
  RotaryOf(scenario).amplifier.noise_V = 0.0;
  RotaryOf(scenario).laser.power_W = 1e-7;
  RotaryOf(scenario).chain.low_pass_Hz = low_pass_Hz;
  return scenario;
}

// White noise of a band B behind a pole: variance x (pi / 2) corner / B, correlated by exp(-t / lag).
TEST(LowPass, NarrowsAndCorrelatesTheLightsNoise) {
  constexpr int kScans = 60000;
  const double corner_Hz = 4000.0, lag_s = 1.0 / (units::turn * corner_Hz), scan_s = 16e-6;
  const double open_V = Twin(OnlyTheLightsNoise(0.0)).Bench().adc.Acquire(kScans, false).channel[0].std_V;
  Twin twin(OnlyTheLightsNoise(corner_Hz));
  const Acquisition block = twin.Bench().adc.Acquire(kScans, true);
  const double share = std::sqrt(0.5 * units::kPi * corner_Hz / 100e3);
  // Some 20000 independent samples: 0.5 %; steps of the converter add as little.
  EXPECT_NEAR(block.channel[0].std_V / open_V, share, 0.03 * share);
  const double lsb_V = 20.0 / 65536.0, mean = block.channel[0].mean_V / lsb_V;
  double products = 0.0;
  for (std::size_t s = 1; s < kScans; ++s)
    products += (block.raw[kChannels * s] - mean) * (block.raw[kChannels * (s - 1)] - mean) / (kScans - 1);
  const double variance = block.channel[0].std_V * block.channel[0].std_V / (lsb_V * lsb_V);
  EXPECT_NEAR(products / variance, std::exp(-scan_s / lag_s), 0.03);
}

TEST(LowPass, LeavesABenchAtRestAsItIs) {
  Scenario scenario = Quiet();
  RotaryOf(scenario).amplifier.offset_V = {0.1, -0.2, 0.3, -0.4};
  const Acquisition open = Twin(scenario).Bench().adc.Acquire(100, false);
  RotaryOf(scenario).chain.low_pass_Hz = 1000.0;
  const Acquisition passed = Twin(scenario).Bench().adc.Acquire(100, false);
  for (std::size_t c = 0; c < kChannels; ++c) EXPECT_EQ(open.channel[c].mean_V, passed.channel[c].mean_V);
}

/// A sine of 137 Hz behind 100 Hz, at its place on the clock, and what the pole makes of it.
constexpr double kTone_Hz = 137.0, kCorner_Hz = 100.0;
double LongTone_V(double t_s, double phase_rad) {
  return std::sin(units::turn * kTone_Hz * t_s + phase_rad);
}

// Mean over a block, of the output less what a pole shows that has seen the sine for ever.
double MeanError_V(double phase_rad, bool remembers) {
  const double step_s = 0.25e-3, block_s = 16e-3;
  const LowPass low_pass(kCorner_Hz);
  BlockCourse course(FromSeconds(step_s)), before(FromSeconds(step_s));
  for (int k = 0; k <= 64; ++k) course.Add({LongTone_V(k * step_s, phase_rad), 0.0, 0.0, 0.0});
  for (int k = -200; k <= 0; ++k) before.Add({LongTone_V(k * step_s, phase_rad), 0.0, 0.0, 0.0});
  const BlockCourse passed = remembers ? low_pass.Passed(course, FromSeconds(kStep_s), 4000, before)
                                       : low_pass.Passed(course, FromSeconds(kStep_s), 4000);
  const double x = kTone_Hz / kCorner_Hz, rate = units::turn * kTone_Hz, behind_rad = phase_rad - std::atan(x);
  const double expected_V =
      (std::cos(behind_rad) - std::cos(rate * block_s + behind_rad)) / (rate * block_s * std::hypot(1.0, x));
  return std::abs(passed.Mean_V(0) - expected_V);
}

TEST(LowPass, RemembersWhatWasBeforeTheBlockOrIsWrongByNoMoreThanIsSaid) {
  const double x2 = std::pow(kTone_Hz / kCorner_Hz, 2), lag_s = LowPass(kCorner_Hz).Lag_s();
  const double said_V = 2.0 * x2 / (1.0 + x2) * lag_s / 16e-3;
  double most_V = 0.0;
  for (const double phase_rad : {0.0, 0.4, 1.2, 1.6, 2.7}) {
    EXPECT_LT(MeanError_V(phase_rad, true), 1e-4) << phase_rad;  // cubics through the knots
    most_V = std::max(most_V, MeanError_V(phase_rad, false));
  }
  EXPECT_LE(most_V, said_V);
  EXPECT_GT(most_V, 0.9 * said_V);
}

struct PassedTone {
  double frequency_Hz, corner_Hz;
};
constexpr double kToneAmplitude_V = 2e-3;  // 1 um
constexpr int kPassedScans = 1000;         // scans: 16 ms
constexpr double kScan_s = 16e-6, kConversion_s = 4e-6;

/// Of the mean of a block.
double LeftOfTone_V(const PassedTone& tone) {
  const double x = units::kPi * tone.frequency_Hz * kPassedScans * kScan_s;
  return kToneAmplitude_V * std::abs(std::sin(x) / x) / std::hypot(1.0, tone.frequency_Hz / tone.corner_Hz);
}

class PassedTones : public testing::TestWithParam<PassedTone> {};

// The pole has seen the tone for long when a block begins: amplitude / hypot(1, f / corner), atan(f / corner) late.
TEST_P(PassedTones, HaveInABlocksMeanWhatPoleAndBlockLeave) {
  const PassedTone& tone = GetParam();
  Scenario scenario = Quiet();
  scenario.effects.push_back(
      {"tone", "all", {{"amplitude", 1e-6}, {"frequency", tone.frequency_Hz}, {"phase", 0.4}}, "test"});
  RotaryOf(scenario).chain.low_pass_Hz = tone.corner_Hz;
  const double x = tone.frequency_Hz / tone.corner_Hz;
  Twin twin(scenario);
  for (int block = 0; block < 5; ++block) {
    const double start_s = ToSeconds(twin.Bench().clock.Now());
    const Acquisition read = twin.Bench().adc.Acquire(kPassedScans, false);
    for (int c = 0; c < kChannels; ++c) {
      double expected_V = 0.0;
      for (int k = 0; k < kPassedScans; ++k) {
        const double time_s = start_s + k * kScan_s + c * kConversion_s;
        expected_V += kToneAmplitude_V / std::hypot(1.0, x) / kPassedScans *
                      std::sin(units::turn * tone.frequency_Hz * time_s + 0.4 - std::atan(x));
      }
      EXPECT_NEAR(read.channel[c].mean_V, expected_V, 0.01 * LeftOfTone_V(tone))
          << "block " << block << " channel " << c;
    }
    twin.Bench().clock.Wait(FromSeconds(0.0137 * (block + 1)));
  }
}

TEST_P(PassedTones, AreFollowed) {
  const PassedTone& tone = GetParam();
  Scenario scenario = test::SmallNoiseFree();
  scenario.effects.push_back(
      {"tone", "all", {{"amplitude", 1e-6}, {"frequency", tone.frequency_Hz}, {"phase", 0.4}}, "test"});
  RotaryOf(scenario).adc.samples = kPassedScans;
  // Channels are converted up to 12 us one after the other, of which the twin that follows knows nothing.
  const double open_V = LeftOfTone_V({tone.frequency_Hz, 1e9});
  const double within_V = open_V * units::turn * tone.frequency_Hz * 3.0 * kConversion_s;
  ExpectFollowed(
      scenario, [&](RotarySettings& s) { s.chain.low_pass_Hz = tone.corner_Hz; }, 1.5 * within_V, 0.015 * open_V);
}

INSTANTIATE_TEST_SUITE_P(LowPass, PassedTones,
                         testing::Values(PassedTone{20.0, 100.0}, PassedTone{20.0, 1000.0},
                                         PassedTone{137.0, 100.0}, PassedTone{137.0, 1000.0},
                                         PassedTone{970.0, 100.0}, PassedTone{970.0, 1000.0}));

TEST(LowPass, IsFollowedThroughASignalOfTheSameKind) {
  Scenario scenario = test::SmallNoiseFree();
  EffectSettings signal{"signal", "psd_b_y", {{"amplitude", 1e-6}, {"frequency", 137.0}, {"phase", 0.4}}, "test"};
  signal.signal = "tone";
  scenario.effects.push_back(signal);
  RotaryOf(scenario).adc.samples = kPassedScans;
  ExpectFollowed(
      scenario, [](RotarySettings& s) { s.chain.low_pass_Hz = 100.0; }, 3e-6, 50e-6);
}

// A table that creeps in with exp(-t / constant), long after it has arrived: 1 / (1 - lag / constant) of it.
TEST(LowPass, IsFollowedAsATableCreepsIn) {
  for (const double corner_Hz : {5.0, 50.0}) {
    Scenario scenario = test::SmallNoiseFree();
    scenario.effects.push_back(
        {"settling", "", {{"amplitude", 5.0 * units::arcsec}, {"time_constant", 0.2}}, "test"});
    RotaryOf(scenario).adc.samples = kPassedScans;
    RotaryOf(scenario).procedure.dwell_s = {0.02};
    ExpectFollowed(
        scenario, [=](RotarySettings& s) { s.chain.low_pass_Hz = corner_Hz; }, 1e-6, 20e-6);
  }
}

}  // namespace
}  // namespace twinbench::sim
