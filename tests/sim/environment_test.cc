#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "tests/core/input_error.h"
#include "tests/sim/quiet_scenario.h"
#include "twin/benches/rotary_4dof/settings.h"
#include "twin/benches/rotary_4dof/twin/twin.h"
#include "twin/core/stream.h"
#include "twin/model/local_level.h"
#include "twin/sim/environment.h"

namespace twinbench::sim {
namespace {

Time At(double t_s) {
  return Time{} + FromSeconds(t_s);
}

TEST(Environment, AddsDriftAndSwingToItsLevelOrInterpolatesARecord) {
  EnvironmentSettings settings;
  settings.drift_K_h = 0.5;
  settings.swing_K = 0.2;
  settings.swing_period_s = 1200.0;
  Environment room(settings, 1);
  EXPECT_NEAR(room.Temperature_degC(At(0.0)), 20.0, 1e-12);
  EXPECT_NEAR(room.Temperature_degC(At(300.0)), 20.0 + 0.5 / 12.0 + 0.2, 1e-12);
  EXPECT_NEAR(room.AboveReference_K(At(1200.0)), 0.5 / 3.0, 1e-12);
  const TemporaryFolder folder;
  EnvironmentSettings recorded;
  recorded.temperature_file = folder.Write("room.csv", "time_s,temperature_degC\n10,20\n20,21\n");
  EXPECT_DOUBLE_EQ(Environment(recorded, 1).Temperature_degC(At(15.0)), 20.5);
}

TEST(Environment, WalksAsFarAsItsFigureSaysAndTheSameWayWhicheverTimesAreAskedFor) {
  EnvironmentSettings settings;
  settings.random_walk_K_sqrt_h = 0.1;
  Environment often(settings, 7), once(settings, 7);
  for (int k = 0; k < 100; ++k) often.Temperature_degC(At(36.0 * k));
  EXPECT_EQ(often.Temperature_degC(At(3600.0)), once.Temperature_degC(At(3600.0)));
  double sum = 0.0;
  constexpr int kRooms = 400;
  for (std::uint64_t seed = 0; seed < kRooms; ++seed)
    sum += std::pow(Environment(settings, seed).AboveReference_K(At(4.0 * 3600.0)), 2);
  // 0.1 K after one hour is 0.2 K after four; relative deviation of the variance sqrt(2 / 400) = 0.07, 4 of them.
  EXPECT_NEAR(sum / kRooms / 0.04, 1.0, 0.28);
}

// Lengths are those of the scenario at environment.reference_degC and grow from there.

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

TEST(ThermalLengths, PostLaserGratingAndDiodeMoveTheSpotsAsTheyWarm) {
  const double cosine = std::sqrt(1.0 - 0.39 * 0.39);
  // sin(theta) = wavelength x lines: grooves further apart by the share e turn the orders inwards by e tan(theta).
  const double inwards_m = 0.12 * 10e-6 * kWarmer_K * 0.39 / cosine,
               apart_m = 0.12 * 600e3 * 0.01e-9 * kWarmer_K / cosine;
  const double post_m = 2e-6 * kWarmer_K;
  const std::tuple<const char*, std::function<void(RotarySettings&)>, std::array<double, kChannels>, double>
      growing[] = {{"a post lowers the spot", [](auto& s) { s.psd_b.post_growth_m_K = 2e-6; },
                    {0.0, 0.0, 0.0, -post_m}, 1e-12},
                   {"the laser's lifts both", [](auto& s) { s.laser.post_growth_m_K = 2e-6; },
                    {0.0, post_m, 0.0, post_m}, 1e-11},
                   {"a grating turns the orders inwards", [](auto& s) { s.grating.expansion_per_K = 10e-6; },
                    {-inwards_m, 0.0, inwards_m, 0.0}, 1e-3 * inwards_m},
                   {"a longer wave turns them apart",
                    [](auto& s) { s.laser.wavelength_per_kelvin_m = 0.01 * units::nm; },
                    {apart_m, 0.0, -apart_m, 0.0}, 1e-3 * apart_m}};
  for (const auto& [claim, change, expected_m, within_m] : growing) {
    Scenario scenario = Warm();
    change(RotaryOf(scenario));
    const auto spots_m = Spots_m(scenario);
    for (std::size_t c = 0; c < kChannels; ++c)
      EXPECT_NEAR(spots_m[c], expected_m[c], within_m) << claim << " " << c;
  }
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

// A room every 40 s for three hours, by a thermometer with a noise of 0.3 K.
TEST(RoomBehindAThermometer, IsSteadyOrGoesItsWay) {
  constexpr double kNoise_K = 0.3;
  const struct {
    const char* claim;
    double drift_K_h, swing_K;
    double most;  // error rms, of the noise
  } rooms[] = {{"steady", 0.0, 0.0, 0.2}, {"drifts", -5.0, 0.0, 0.6}, {"swings in forty readings", 0.0, 2.0, 0.8}};
  for (const auto& room : rooms) {
    Stream noise(7, "thermometer");
    const Eigen::VectorXd time_s = 40.0 * Eigen::VectorXd::LinSpaced(270, 0.0, 269.0);
    const Eigen::VectorXd true_K =
        room.drift_K_h / 3600.0 * time_s.array() + room.swing_K * (time_s.array() * 2.0 * units::kPi / 1600.0).sin();
    const Eigen::VectorXd shown_K = true_K.unaryExpr([&](double K) { return K + kNoise_K * noise.Normal(); });
    const Eigen::VectorXd error_K = model::Smoothed(time_s, shown_K, kNoise_K) - true_K;
    EXPECT_LT(std::sqrt(error_K.squaredNorm() / 270.0), room.most * kNoise_K) << room.claim;
  }
}

}  // namespace
}  // namespace twinbench::sim
