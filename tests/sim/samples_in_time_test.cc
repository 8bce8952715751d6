#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "tests/sim/quiet_scenario.h"
#include "twin/benches/rotary_4dof/settings.h"
#include "twin/benches/rotary_4dof/twin/twin.h"

/// What happens during an A/D block is in the block. Expected are sums over the converter's instants, written here
/// once more from its description: scan s takes the channel at place k at (4 s + k) / rate.
namespace twinbench::sim {
namespace {

constexpr double kRate_Hz = 250e3;
constexpr double kPsd_V_m = 2000.0;
constexpr int kBlock = 1000;  // scans: 16 ms
/// Spot motion per radian of yaw.
const double kByYaw_m = 0.12 * (1.0 + 1.0 / std::sqrt(1.0 - 0.39 * 0.39));

struct Expected {
  double mean = 0.0, deviation = 0.0;
};

/// @param value  At a time in the block.
Expected Sampled(const std::function<double(double t_s)>& value, int place, int scans) {
  double sum = 0.0, squares = 0.0;
  for (int s = 0; s < scans; ++s) {
    const double v = value((4.0 * s + place) / kRate_Hz);
    sum += v;
    squares += v * v;
  }
  return {sum / scans, std::sqrt((squares - sum * sum / scans) / (scans - 1))};
}

Scenario With(const EffectSettings& effect) {
  Scenario scenario = Quiet();
  scenario.effects.push_back(effect);
  return scenario;
}

struct Tone {
  double frequency_Hz, corner_Hz;  // of a low-pass; 0: none
};

class Tones : public testing::TestWithParam<Tone> {};

// A pole has seen the tone for long when a block begins: amplitude / hypot(1, f / corner), atan(f / corner) late.
TEST_P(Tones, ABlockAveragesWhatThePoleLeavesOfATone) {
  const auto& [frequency_Hz, corner_Hz] = GetParam();
  Scenario scenario =
      With({"tone", "all", {{"amplitude", 1e-6}, {"frequency", frequency_Hz}, {"phase", 0.4}}, "test"});
  RotaryOf(scenario).chain.low_pass_Hz = corner_Hz;
  Twin twin(scenario);
  const double ratio = corner_Hz > 0.0 ? frequency_Hz / corner_Hz : 0.0;
  const double amplitude_V = 1e-6 * kPsd_V_m / std::hypot(1.0, ratio);
  const double x = units::kPi * frequency_Hz * kBlock * 4.0 / kRate_Hz;
  for (int block = 0; block < 7; ++block) {
    const double start_s = ToSeconds(twin.Bench().clock.Now());
    const Acquisition read = twin.Bench().adc.Acquire(kBlock, false);
    for (int c = 0; c < kChannels; ++c) {
      const Expected expected = Sampled(
          [&](double t_s) {
            return amplitude_V * std::sin(units::turn * frequency_Hz * (start_s + t_s) + 0.4 - std::atan(ratio));
          },
          c, kBlock);
      EXPECT_NEAR(read.channel[c].mean_V, expected.mean, 0.01 * amplitude_V * std::abs(std::sin(x) / x)) << c;
      EXPECT_NEAR(read.channel[c].std_V, expected.deviation, 0.02 * expected.deviation) << c;
    }
    twin.Bench().clock.Wait(FromSeconds(0.0137 * (block + 1)));
  }
}

INSTANTIATE_TEST_SUITE_P(FromOneHertzToAKilohertz, Tones,
                         testing::Values(Tone{1.0, 0}, Tone{7.3, 0}, Tone{50.0, 0}, Tone{137.0, 0}, Tone{400.0, 0},
                                         Tone{970.0, 0}, Tone{20.0, 100.0}, Tone{20.0, 1000.0}, Tone{137.0, 100.0},
                                         Tone{137.0, 1000.0}, Tone{970.0, 100.0}, Tone{970.0, 1000.0}));

TEST(SamplesInTime, ABlockTakenOnTheWayHoldsTheMotion) {
  const Scenario scenario = Quiet();
  Twin twin(scenario);
  const double travel_rad = 20.0 * units::arcsec, duration_s = RotaryOf(scenario).target.move_time_s;
  RotaryBench bench = twin.Bench();
  bench.target.StartMove(travel_rad);
  const double before_s = 0.3 * duration_s;
  bench.clock.Wait(FromSeconds(before_s));
  const Acquisition block = bench.adc.Acquire(kBlock, false);
  const Expected expected = Sampled(
      [&](double t_s) {
        const double s = (before_s + t_s) / duration_s;
        return -kByYaw_m * kPsd_V_m * travel_rad * s * s * s * (10.0 - 15.0 * s + 6.0 * s * s);
      },
      0, kBlock);
  EXPECT_NEAR(block.channel[0].mean_V, expected.mean, 1e-3 * std::abs(expected.mean));
  EXPECT_NEAR(block.channel[0].std_V, expected.deviation, 0.02 * expected.deviation);
  EXPECT_GT(expected.deviation, 0.0);
}

TEST(SamplesInTime, ABlockAtRestIsSteadyAndASpotThatLeavesDuringOneLosesIt) {
  Twin twin(Quiet());
  RotaryBench bench = twin.Bench();
  EXPECT_EQ(bench.adc.Acquire(kBlock, false).channel[0].std_V, 0.0);
  bench.target.StartMove(2.0 * units::deg);  // 9 mm on a PSD that reaches 5 mm
  EXPECT_EQ(bench.adc.Acquire(100000, false).status, ReadingStatus::kNoLight);
}

double Yaw_arcsec(Twin& twin) {
  return twin.Bench().autocollimator.Read().yaw_rad / units::arcsec;
}

TEST(SamplesInTime, PlayIsCrossedBeforeTheRotorFollows) {
  const double half_rad = 10.0 * units::arcsec;
  Twin twin(With({"backlash", "target", {{"half_width", half_rad}}, "test"}));
  RotaryBench bench = twin.Bench();
  bench.target.StartMove(100.0 * units::arcsec);
  bench.target.WaitSettled();
  EXPECT_NEAR(Yaw_arcsec(twin), 90.0, 1e-6);
  bench.target.StartMove(0.0);
  bench.clock.Wait(FromSeconds(0.02));
  EXPECT_NEAR(Yaw_arcsec(twin), 90.0, 1e-6);  // the command has gone less than the play's width
  bench.target.WaitSettled();
  EXPECT_NEAR(Yaw_arcsec(twin), 10.0, 1e-6);
}

TEST(SamplesInTime, SettlingBeginsWithTheMove) {
  const double amplitude_rad = 5.0 * units::arcsec;
  Twin twin(With({"settling", "", {{"amplitude", amplitude_rad}, {"time_constant", 0.5}}, "test"}));
  Twin without(Quiet());
  for (Twin* each : {&twin, &without}) each->Bench().target.StartMove(100.0 * units::arcsec);
  double before = 0.0;
  for (int k = 0; k < 20; ++k) {
    const double behind = Yaw_arcsec(without) - Yaw_arcsec(twin);
    EXPECT_GE(behind, -1e-9) << k;
    EXPECT_LE(behind, 5.0 + 1e-9) << k;
    EXPECT_LT(std::abs(behind - before), 2.0) << k;  // nothing jumps
    before = behind;
    for (Twin* each : {&twin, &without}) each->Bench().clock.Wait(FromSeconds(0.05));
  }
}

TEST(SamplesInTime, EveryDeviceSchedulesItsEvents) {
  Scenario scenario = Quiet();
  RotaryOf(scenario).mechanics.fidelity = "linear";
  Twin twin(scenario);
  RotaryBench bench = twin.Bench();
  bench.fixture.Mount(0, 0.0, 0.0);
  bench.goniometer.MoveTo(units::arcsec, 0.0);
  bench.target.StartMove(units::arcsec);
  bench.reference.StartMove(units::arcsec);
  bench.target.WaitSettled();
  bench.reference.WaitSettled();
  bench.autocollimator.Read();
  bench.thermometer.Read_degC();
  bench.adc.Acquire(10, false);
  for (const char* device :
       {"fixture", "goniometer", "target", "reference", "autocollimator", "thermometer", "adc"})
    EXPECT_GT(twin.ScheduledEvents().at(device), 0U) << device;
}

}  // namespace
}  // namespace twinbench::sim
