#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "tests/sim/quiet_scenario.h"
#include "tests/support/small_scenario.h"
#include "tests/support/twin_run.h"
#include "twin/benches/rotary_4dof/settings.h"
#include "twin/benches/rotary_4dof/twin/follow.h"
#include "twin/core/errors.h"

namespace twinbench::sim {
namespace {

std::string Written(const std::string& name, const std::string& text) {
  const std::string path = testing::TempDir() + name;
  std::ofstream(path) << text;
  return path;
}

Scenario Still() {
  Scenario scenario = Quiet();
  scenario.noise_free = false;
  RotaryOf(scenario).amplifier.noise_V = 0.0;
  return scenario;
}

Acquisition Block(const Scenario& scenario, int scans) {
  Twin twin(scenario);
  return twin.Bench().adc.Acquire(scans, false);
}

TEST(Electronics, AddsTheConvertersNonLinearity) {
  Scenario scenario = Quiet();
  RotaryOf(scenario).amplifier.offset_V = {0.0, 1.0, -2.0, 9.0};
  const Acquisition straight = Block(scenario, 10);
  RotaryOf(scenario).adc.inl_file = Written("inl.csv", "voltage_V,error_mV\n-4,-2\n0,0\n4,1\n");
  const Acquisition bent = Block(scenario, 10);
  const std::array<double, kChannels> expected_V = {0.0, 0.25e-3, -1.0e-3, 1e-3};
  for (std::size_t c = 0; c < kChannels; ++c)
    EXPECT_NEAR(bent.channel[c].mean_V - straight.channel[c].mean_V, expected_V[c], 1e-9) << c;
}

TEST(Electronics, IsFollowedWithItsNonLinearity) {
  Scenario scenario = test::SmallNoiseFree();
  const test::TwinRun straight = test::RunTwin(scenario);
  RotaryOf(scenario).adc.inl_file = Written("inl_follow.csv", "voltage_V,error_mV\n-10,5\n0,0\n10,5\n");
  const test::TwinRun bent = test::RunTwin(scenario);
  const Eigen::MatrixXd followed_V =
      FollowRotary(bent.scenario, bent.readings, std::make_shared<DrivesOnce>())->Predict() -
      FollowRotary(straight.scenario, straight.readings, std::make_shared<DrivesOnce>())->Predict();
  double most_V = 0.0;
  for (std::size_t i = 0; i < bent.readings.size(); ++i) {
    for (int c = 0; c < kChannels; ++c) {
      const double shown_V = bent.readings[i].mean_V[c] - straight.readings[i].mean_V[c];
      EXPECT_NEAR(followed_V(static_cast<Eigen::Index>(i), c), shown_V, 0.02e-3);
      most_V = std::max(most_V, std::abs(shown_V));
    }
  }
  EXPECT_GT(most_V, 0.2e-3);
}

TEST(Electronics, SaysWhatIsWrongWithATableOfItsNonLinearity) {
  Scenario scenario = Quiet();
  RotaryOf(scenario).adc.inl_file = Written("inl_bad.csv", "voltage_V,error_mV\n1,0\n1,0\n");
  EXPECT_THROW(Twin{scenario}, InputError);
}

// A wrong instant t of a sine a sin(w t) is a wrong voltage: standard deviation a w t / sqrt(2), to first order.
TEST(Electronics, TurnsJitterIntoNoiseWhereTheSignalChanges) {
  constexpr int kScans = 100000;  // 8000 periods
  const double a_V = 0.5, frequency_Hz = 5000.0, jitter_s = 16e-6;
  Scenario scenario = Still();
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
  Scenario scenario = Still();
  RotaryOf(scenario).adc.lost_fraction = 0.2;
  const Acquisition block = Block(scenario, 10000);
  EXPECT_NEAR(block.n_samples, 8000, 200);  // 5 standard deviations
  EXPECT_EQ(block.status, ReadingStatus::kOk);
}

TEST(Electronics, FlickersFromBlockToBlock) {
  Scenario scenario = Still();
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
