#include "twin/sim/code_widths.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "tests/sim/follow_key.h"
#include "twin/sim/ad_sampler.h"

namespace twinbench::sim {
namespace {

const AdcSettings kConverter;  // 16 bits, +-10 V
constexpr double kCode_V = 20.0 / 65536.0;
constexpr int kRampCodes = 400, kAHit = 100;  // conversions of one channel a code

/// How often each code comes as channel 0 goes up slowly.
std::map<int, int> CodeDensity(const CodeWidths& widths) {
  AdInput input;
  for (ChannelInput& channel : input.channel) channel.level_V = 0.0;
  input.channel[0].slope_V_s = kCode_V / kAHit * kConverter.rate_Hz / kChannels;
  input.widths = &widths;
  Stream noise(1, "test");
  const AdBlock block = TakeBlock(kConverter, input, {.n_samples = kRampCodes * kAHit, .keep_raw = true}, noise);
  std::map<int, int> hits;
  for (std::size_t i = 0; i < block.raw.size(); i += kChannels) ++hits[block.raw[i]];
  return hits;
}

TEST(CodeWidths, AreTheCodeDensityOfARamp) {
  const CodeWidths widths(0.3, 16, 7);
  std::map<int, int> hits = CodeDensity(widths);
  double squares = 0.0, sum = 0.0;
  for (int code = 1; code < kRampCodes - 1; ++code) {
    const double width = 1.0 + widths.Off_lsb(code + 1) - widths.Off_lsb(code);
    EXPECT_NEAR(hits[code], kAHit * width, 1.01) << code;  // both ends cut a step of the ramp
    squares += std::pow(hits[code] / double(kAHit) - 1.0, 2) / (kRampCodes - 2);
    sum += hits[code] / double(kAHit) - 1.0;
  }
  EXPECT_NEAR(std::sqrt(squares), 0.3, 0.03);  // of 400 widths, neighbours of which share an edge: 4 %
  EXPECT_LT(std::abs(sum), 1.0);               // no integral non-linearity beyond two edges
}

TEST(CodeWidths, AreAllOneWhereNoneAreStated) {
  EXPECT_TRUE(CodeWidths(0.0, 16, 7).AreEqual());
  for (const auto& [code, hits] : CodeDensity(CodeWidths(0.0, 16, 7))) {
    if (code <= 0 || code >= kRampCodes) continue;
    EXPECT_NEAR(hits, kAHit, 1.01) << code;
  }
}

TEST(CodeWidths, ShiftTheMeanOfANoisyLevelAsTheirEdgesSay) {
  const CodeWidths widths(0.4, 16, 11);
  constexpr int kScans = 400000;
  double most = 0.0;
  for (const double level_lsb : {-1000.3, 0.0, 7.5, 20000.2}) {
    AdInput input;
    for (ChannelInput& channel : input.channel) {
      channel.level_V = level_lsb * kCode_V;
      channel.noise_V = 0.5 * kCode_V;
    }
    input.widths = &widths;
    Stream noise(3, "test");
    const AdBlock block = TakeBlock(kConverter, input, {.n_samples = kScans, .every_sample = false}, noise);
    EXPECT_TRUE(block.drew_every_sample);
    double mean_lsb = 0.0;
    for (const ChannelBlock& channel : block.channel) mean_lsb += channel.mean_V / kCode_V / kChannels;
    // Steps of one code under half a code of noise: sin(2 pi level) exp(-2 pi^2 / 4) / pi.
    const double even = -std::sin(units::turn * level_lsb) * std::exp(-0.5 * units::kPi * units::kPi) / units::kPi;
    const double expected = widths.Shift_lsb(level_lsb, 0.5);
    EXPECT_NEAR(mean_lsb - level_lsb, expected + even, 4e-3) << level_lsb;  // 5 standard deviations of the mean
    most = std::max(most, std::abs(expected));
  }
  EXPECT_GT(most, 0.05);
}

/// Root mean square of what the twin that follows the record leaves [V].
double Left_V(const Scenario& scenario, const std::vector<Reading>& readings) {
  const Eigen::MatrixXd followed_V = FollowRotary(scenario, readings, std::make_shared<DrivesOnce>())->Predict();
  double squares_V2 = 0.0;
  for (std::size_t i = 0; i < readings.size(); ++i) {
    for (int c = 0; c < kChannels; ++c)
      squares_V2 += std::pow(readings[i].mean_V[c] - followed_V(static_cast<Eigen::Index>(i), c), 2);
  }
  return std::sqrt(squares_V2 / (kChannels * double(readings.size())));
}

TEST(CodeWidths, AreFollowed) {
  Scenario scenario = test::SmallNoiseFree();
  scenario.noise_free = false;
  scenario.environment.sensor_noise_K = 0.0;
  RotarySettings& own = RotaryOf(scenario);
  own.autocollimator.noise_rad = 0.0;
  own.amplifier.noise_V = 0.2e-3;
  own.adc.samples = 20000;  // noise of a mean: 1.4 uV
  own.chain.dnl_lsb = 0.4;
  const test::TwinRun run = test::RunTwin(scenario);
  EXPECT_LT(Left_V(scenario, run.readings), 3e-6);
  RotaryOf(scenario).chain.dnl_lsb = 0.0;
  EXPECT_GT(Left_V(scenario, run.readings), 10e-6);
}

}  // namespace
}  // namespace twinbench::sim
