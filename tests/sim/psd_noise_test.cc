#include "twin/benches/rotary_4dof/twin/psd_noise.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/sim/quiet_scenario.h"
#include "twin/benches/rotary_4dof/twin/twin.h"

namespace twinbench::sim {
namespace {

PsdSettings ShotNoiseOnly() {
  PsdSettings psd;
  psd.dark_current_A = 0.0;
  psd.electrode_resistance_ohm = 1e15;
  return psd;
}

// (L / 2) sqrt(2 q B / I) in the centre: 1 mW x 0.45 A/W = 0.45 mA, 100 kHz, 10 mm.
TEST(PsdNoise, IsTheShotNoiseOfTheLightAndThatOfDarkCurrentAndResistanceFallsAsTheLight) {
  const double expected_m = 5e-3 * std::sqrt(2.0 * 1.602176634e-19 * 100e3 / 0.45e-3);
  EXPECT_NEAR(PsdNoise_m(ShotNoiseOnly(), 1e-3, 10e-3, 0.0), expected_m, 1e-6 * expected_m);
  EXPECT_NEAR(PsdNoise_m(ShotNoiseOnly(), 1e-3, 10e-3, 4e-3), 0.6 * expected_m, 1e-6 * expected_m);
  PsdSettings psd = ShotNoiseOnly();
  psd.dark_current_A = 1.0;
  EXPECT_NEAR(PsdNoise_m(psd, 1e-9, 10e-3, 0.0) / PsdNoise_m(psd, 4e-9, 10e-3, 0.0), 4.0, 1e-3);
  // Johnson noise of 10 kohm in 100 kHz: 4 k T B / R = 1.62e-19 A^2, at both electrodes.
  psd = ShotNoiseOnly();
  psd.electrode_resistance_ohm = 10e3;
  const double johnson_m = 5e-3 * std::sqrt(2.0 * 1.6190e-19) / (0.45 * 1e-12);
  EXPECT_NEAR(PsdNoise_m(psd, 1e-12, 10e-3, 0.0) / johnson_m, 1.0, 1e-3);
}

/// Root mean square over channels of a block's deviation, nothing being noisy but the light.
double Scatter_V(double power_W) {
  Scenario scenario = OnlyTheLightsNoise();
  RotaryOf(scenario).laser.power_W = power_W;
  for (PsdSettings* psd : {&RotaryOf(scenario).psd_a, &RotaryOf(scenario).psd_b}) {
    psd->dark_current_A = 0.0;
    psd->electrode_resistance_ohm = 1e9;
  }
  Twin twin(scenario);
  const Acquisition block = twin.Bench().adc.Acquire(20000, false);
  double squares_V2 = 0.0;
  for (const ChannelBlock& channel : block.channel) squares_V2 += channel.std_V * channel.std_V / kChannels;
  return std::sqrt(squares_V2);
}

TEST(PsdNoise, ScatterFallsAsOneOverTheRootOfThePower) {
  const double bright_V = Scatter_V(2e-6);
  for (const double share : {0.25, 0.04, 0.01})
    EXPECT_NEAR(Scatter_V(2e-6 * share) / bright_V * std::sqrt(share), 1.0, 0.03) << share;
}

}  // namespace
}  // namespace twinbench::sim
