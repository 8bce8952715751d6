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

// 20 Hz behind 1 kHz: 0.02 rad late, which is followed; 0.02^2 / 2 smaller, which is not: 0.4 uV of 2 mV.
TEST(LowPass, IsFollowedByItsLag) {
  Scenario scenario = test::SmallNoiseFree();
  scenario.effects.push_back({"tone", "all", {{"amplitude", 1e-6}, {"frequency", 20.0}, {"phase", 0.4}}, "test"});
  ExpectFollowed(
      scenario, [](RotarySettings& s) { s.chain.low_pass_Hz = 1000.0; }, 1e-6, 20e-6);
}

}  // namespace
}  // namespace twinbench::sim
