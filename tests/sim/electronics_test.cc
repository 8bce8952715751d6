#include <gtest/gtest.h>

#include <cmath>

#include "tests/core/input_error.h"
#include "tests/sim/quiet_scenario.h"
#include "twin/benches/rotary_4dof/settings.h"
#include "twin/benches/rotary_4dof/twin/follow.h"

namespace twinbench::sim {
namespace {

Acquisition Block(const Scenario& scenario, int scans) {
  Twin twin(scenario);
  return twin.Bench().adc.Acquire(scans, false);
}

TEST(Electronics, AddsTheConvertersNonLinearity) {
  const TemporaryFolder folder;
  Scenario scenario = Quiet();
  RotaryOf(scenario).amplifier.offset_V = {0.0, 1.0, -2.0, 9.0};
  const Acquisition straight = Block(scenario, 10);
  RotaryOf(scenario).adc.inl_file = folder.Write("inl.csv", "voltage_V,error_mV\n-4,-2\n0,0\n4,1\n");
  const Acquisition bent = Block(scenario, 10);
  const std::array<double, kChannels> expected_V = {0.0, 0.25e-3, -1.0e-3, 1e-3};
  for (std::size_t c = 0; c < kChannels; ++c)
    EXPECT_NEAR(bent.channel[c].mean_V - straight.channel[c].mean_V, expected_V[c], 1e-9) << c;
}

// A wrong instant t of a sine a sin(w t) is a wrong voltage: standard deviation a w t / sqrt(2), to first order.
TEST(Electronics, TurnsJitterIntoNoiseWhereTheSignalChanges) {
  constexpr int kScans = 100000;  // 8000 periods
  const double a_V = 0.5, frequency_Hz = 5000.0, jitter_s = 16e-6;
  Scenario scenario = OnlyTheLightsNoise();
  RotaryOf(scenario).adc.jitter_s = jitter_s;
  const double quiet_V = Block(scenario, kScans).channel[0].std_V;
  RotaryOf(scenario).amplifier.hum_V = a_V;
  RotaryOf(scenario).amplifier.hum_Hz = frequency_Hz;
  const double expected_V = a_V * units::turn * frequency_Hz * jitter_s / std::sqrt(2.0);
  const double shown_V = Block(scenario, kScans).channel[0].std_V;
  // The sine itself is in it too. Products of sine and noise leave 1.3 % by chance.
  EXPECT_NEAR(std::sqrt(shown_V * shown_V - 0.5 * a_V * a_V), expected_V, 0.05 * expected_V);
  EXPECT_LT(quiet_V, 0.01 * expected_V);
}

TEST(Electronics, LosesScans) {
  Scenario scenario = OnlyTheLightsNoise();
  RotaryOf(scenario).adc.lost_fraction = 0.2;
  const Acquisition block = Block(scenario, 10000);
  EXPECT_NEAR(block.n_samples, 8000, 200);  // 5 standard deviations
  EXPECT_EQ(block.status, ReadingStatus::kOk);
}

TEST(Electronics, FlickersFromBlockToBlock) {
  Scenario scenario = OnlyTheLightsNoise();
  RotaryOf(scenario).amplifier.flicker_V = 10e-3;
  Twin twin(scenario);
  double squares_V2 = 0.0;
  constexpr int kBlocks = 200;
  for (int k = 0; k < kBlocks; ++k) {
    for (const ChannelBlock& channel : twin.Bench().adc.Acquire(10, false).channel)
      squares_V2 += channel.mean_V * channel.mean_V / (kBlocks * kChannels);
    twin.Bench().clock.Wait(std::chrono::minutes(1));
  }
  EXPECT_NEAR(std::sqrt(squares_V2), 10e-3 * std::sqrt(6.0), 3e-3);  // six decades
}

}  // namespace
}  // namespace twinbench::sim
