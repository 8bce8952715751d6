#include <gtest/gtest.h>

#include <cmath>

#include "tests/sim/quiet_scenario.h"
#include "twin/benches/rotary_4dof/settings.h"
#include "twin/benches/rotary_4dof/twin/twin.h"

/// Lengths are those of the scenario at environment.reference_degC and grow from there.
namespace twinbench::sim {
namespace {

constexpr double kPsd_V_per_m = 2000.0, kWarmer_K = 15.0;

Scenario Warm() {
  Scenario scenario = Quiet();
  scenario.environment.temperature_degC = scenario.environment.reference_degC + kWarmer_K;
  return scenario;
}

/// Places of the spots, in channel order.
std::array<double, kChannels> Spots_m(const Scenario& scenario) {
  Twin twin(scenario);
  const Acquisition block = twin.Bench().adc.Acquire(4, false);
  std::array<double, kChannels> spots_m{};
  for (std::size_t c = 0; c < kChannels; ++c) spots_m[c] = block.channel[c].mean_V / kPsd_V_per_m;
  return spots_m;
}

TEST(ThermalLengths, APostThatGrowsLowersTheSpot) {
  Scenario scenario = Warm();
  RotaryOf(scenario).psd_b.post_growth_m_K = 2e-6;
  const auto spots_m = Spots_m(scenario);
  EXPECT_NEAR(spots_m[3], -2e-6 * kWarmer_K, 1e-12);
  EXPECT_NEAR(spots_m[1], 0.0, 1e-12);
}

TEST(ThermalLengths, ALaserThatGrowsLiftsBothSpots) {
  Scenario scenario = Warm();
  RotaryOf(scenario).laser.post_growth_m_K = 2e-6;
  for (const int c : {1, 3}) EXPECT_NEAR(Spots_m(scenario)[c], 2e-6 * kWarmer_K, 1e-11) << c;
}

// sin(theta) = wavelength x lines: grooves further apart by the share e turn the orders inwards by e tan(theta).
TEST(ThermalLengths, AGratingThatGrowsTurnsTheOrdersInwards) {
  Scenario scenario = Warm();
  RotaryOf(scenario).grating.expansion_per_K = 10e-6;
  const double turned_rad = 10e-6 * kWarmer_K * 0.39 / std::sqrt(1.0 - 0.39 * 0.39);
  const auto spots_m = Spots_m(scenario);
  EXPECT_NEAR(spots_m[0], -0.12 * turned_rad, 1e-3 * 0.12 * turned_rad);
  EXPECT_NEAR(spots_m[2], 0.12 * turned_rad, 1e-3 * 0.12 * turned_rad);
}

// Behind the grating a beam with the pitch p climbs by p over the distance.
TEST(ThermalLengths, ADistanceThatGrowsMakesALongerWay) {
  Scenario scenario = Warm();
  RotaryOf(scenario).laser.pitch_rad = 5e-3;
  const double before_m = Spots_m(scenario)[1];
  RotaryOf(scenario).psd_a.distance_expansion_per_K = 100e-6;
  const double expected_m = 0.12 * 100e-6 * kWarmer_K * 5e-3;
  EXPECT_NEAR(Spots_m(scenario)[1] - before_m, expected_m, 1e-2 * expected_m);
}

TEST(ThermalLengths, TheDiodeHopsToItsNextModeAsItWarms) {
  Scenario scenario = Quiet();
  RotaryOf(scenario).laser.mode_hop_K = 2.0;
  RotaryOf(scenario).laser.mode_spacing_m = 0.25e-9;
  const auto wavelengths_off = [&](double above_K) {
    scenario.environment.temperature_degC = scenario.environment.reference_degC + above_K;
    const double turned_rad = 0.25e-9 * 600e3 / std::sqrt(1.0 - 0.39 * 0.39);  // of one hop
    return Spots_m(scenario)[0] / (0.12 * turned_rad);
  };
  EXPECT_NEAR(wavelengths_off(0.9), 0.0, 1e-6);
  EXPECT_NEAR(wavelengths_off(1.1), 1.0, 1e-2);
  EXPECT_NEAR(wavelengths_off(4.5), 2.0, 1e-2);
}

}  // namespace
}  // namespace twinbench::sim
