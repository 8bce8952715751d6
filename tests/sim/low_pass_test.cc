#include "twin/sim/low_pass.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/sim/quiet_scenario.h"
#include "twin/benches/rotary_4dof/twin/twin.h"

namespace twinbench::sim {
namespace {

constexpr double kStep_s = 4e-6;

// An edge that takes one knot's distance h is followed by 1 - (lag / h) (1 - exp(-h / lag)) exp(-t / lag).
TEST(LowPass, FollowsAStepExponentiallyAndIsOneLagBehindARamp) {
  BlockCourse edge(FromSeconds(kStep_s));
  for (int k = 0; k <= 1000; ++k) edge.Add({k < 600 ? 0.0 : 1.0, 5.0 * k * kStep_s, 2.0, k < 600 ? 0.0 : -3.0});
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
  for (const double t_s : {0.0, 1e-4, 4e-3})
    EXPECT_NEAR(passed.At_V(1, t_s), 5.0 * (t_s - low_pass.Lag_s()), 1e-9) << t_s;
}

Scenario Dim(double low_pass_Hz) {
  Scenario scenario = OnlyTheLightsNoise();
  RotaryOf(scenario).laser.power_W = 1e-7;
  RotaryOf(scenario).chain.low_pass_Hz = low_pass_Hz;
  return scenario;
}

// White noise of a band B behind a pole: variance x (pi / 2) corner / B, correlated by exp(-t / lag).
TEST(LowPass, NarrowsAndCorrelatesTheLightsNoise) {
  constexpr int kScans = 60000;
  const double corner_Hz = 4000.0, lag_s = 1.0 / (units::turn * corner_Hz), scan_s = 16e-6;
  const double open_V = Twin(Dim(0.0)).Bench().adc.Acquire(kScans, false).channel[0].std_V;
  Twin twin(Dim(corner_Hz));
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

}  // namespace
}  // namespace twinbench::sim
