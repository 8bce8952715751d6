#include <gtest/gtest.h>

#include <cmath>

#include "tests/sim/quiet_scenario.h"
#include "twin/benches/rotary_4dof/twin/psd_noise.h"
#include "twin/benches/rotary_4dof/twin/twin.h"

/// The laser's power goes up and down: a PSD's quotient does not see it but where a background counts as signal.
namespace twinbench::sim {
namespace {

constexpr double kPitch_rad = 5e-3;
constexpr double kCurrent_A = 0.45 * 5e-3 * 0.339, kBackground_A = 100e-6;
constexpr double kShare = kCurrent_A / (kCurrent_A + kBackground_A);

/// Both spots 1.6 mm above the middle.
Scenario Lifted(bool noise_free = true) {
  Scenario scenario = OnlyTheLightsNoise();
  scenario.noise_free = noise_free;
  RotaryOf(scenario).laser.pitch_rad = kPitch_rad;
  return scenario;
}

void LetRoomLightIn(Scenario& scenario) {
  RotaryOf(scenario).psd_a.background_A = RotaryOf(scenario).psd_b.background_A = kBackground_A;
}

Acquisition LongBlock(const Scenario& scenario, bool keep_raw = false) {
  return Twin(scenario).Bench().adc.Acquire(20000, keep_raw);
}

TEST(IntensityNoise, CancelsWithoutABackground) {
  Scenario scenario = Lifted(false);
  const Acquisition quiet = LongBlock(scenario);
  RotaryOf(scenario).laser.rin_dB_Hz = -70.0;  // 10 % in 100 kHz
  const Acquisition noisy = LongBlock(scenario);
  for (std::size_t c = 0; c < kChannels; ++c) {
    EXPECT_EQ(noisy.channel[c].mean_V, quiet.channel[c].mean_V) << c;
    EXPECT_EQ(noisy.channel[c].std_V, quiet.channel[c].std_V) << c;
  }
}

TEST(IntensityNoise, ShowsThroughABackground) {
  Scenario scenario = Lifted(false);
  LetRoomLightIn(scenario);
  const Acquisition quiet = LongBlock(scenario);
  RotaryOf(scenario).laser.rin_dB_Hz = -90.0;
  const Acquisition noisy = LongBlock(scenario);
  const double relative = std::sqrt(1e-9 * 100e3);
  for (const std::size_t c : {1u, 3u}) {
    const double expected_V = std::abs(quiet.channel[c].mean_V) * (1.0 - kShare) * relative;
    const double added_V = std::sqrt(std::pow(noisy.channel[c].std_V, 2) - std::pow(quiet.channel[c].std_V, 2));
    EXPECT_NEAR(added_V, expected_V, 0.03 * expected_V) << c;  // 20000 samples: 0.5 %
    EXPECT_LT(noisy.channel[c - 1].std_V, 0.1 * expected_V) << "in the middle nothing is to be seen";
  }
}

TEST(IntensityNoise, IsCommonToBothDetectorsBehindALowPass) {
  Scenario scenario = Lifted(false);
  LetRoomLightIn(scenario);
  RotaryOf(scenario).laser.rin_dB_Hz = -80.0;
  RotaryOf(scenario).chain.low_pass_Hz = 2000.0;
  const Acquisition block = LongBlock(scenario, true);
  const double lsb_V = 20.0 / 65536.0;
  double products = 0.0;
  for (std::size_t i = 0; i < block.raw.size(); i += kChannels)
    products += (block.raw[i + 1] - block.channel[1].mean_V / lsb_V) *
                (block.raw[i + 3] - block.channel[3].mean_V / lsb_V) / 20000.0;
  const double correlation = products * lsb_V * lsb_V / (block.channel[1].std_V * block.channel[3].std_V);
  // Two conversions apart: exp(-8 us x 2 pi x 2 kHz).
  EXPECT_NEAR(correlation, std::exp(-8e-6 * units::turn * 2000.0), 0.02);
}

}  // namespace
}  // namespace twinbench::sim
