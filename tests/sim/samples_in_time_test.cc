#include "tests/core/input_error.h"
#include "tests/support/rotary_scenario.h"
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

// A pole has seen the tone for long when a block begins: amplitude / hypot(1, f / corner), atan(f / corner) late.
void ExpectAveraged(double frequency_Hz, double corner_Hz) {
  SCOPED_TRACE(testing::Message() << frequency_Hz << " Hz behind " << corner_Hz << " Hz");
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

TEST(SamplesInTime, ABlockAveragesWhatThePoleLeavesOfAToneFromOneHertzToAKilohertz) {
  for (const double frequency_Hz : {1.0, 7.3, 50.0, 137.0, 400.0, 970.0})
    ExpectAveraged(frequency_Hz, 0.0);  // no low-pass
  for (const double frequency_Hz : {20.0, 137.0, 970.0})
    for (const double corner_Hz : {100.0, 1000.0}) ExpectAveraged(frequency_Hz, corner_Hz);
}

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

double Yaw_arcsec(Twin& twin) { return twin.Bench().autocollimator.Read().yaw_rad / units::arcsec; }

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
