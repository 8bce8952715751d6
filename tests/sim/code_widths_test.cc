#include "twin/sim/code_widths.h"

#include "tests/core/input_error.h"
#include "tests/core/refusals.h"
#include "tests/support/small_scenario.h"
#include "tests/support/twin_run.h"
#include "twin/benches/rotary_4dof/twin/twin.h"
#include "twin/sim/ad_sampler.h"
#include "twin/sim/code_width_table.h"

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

TEST(CodeWidths, AreTheCodeDensityOfARampAndAllOneWhereNoneAreStated) {
  EXPECT_TRUE(CodeWidths(0.0, 16, 7).AreEqual());
  std::map<int, int> equal = CodeDensity(CodeWidths(0.0, 16, 7));
  for (int code = 1; code < kRampCodes; ++code) EXPECT_NEAR(equal[code], kAHit, 1.01) << code;
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

/// 6 bits: codes -32 .. 31. Two wide codes, a missing one and a narrow one.
const std::map<std::int32_t, double> kFew_lsb = {{-3, 0.5}, {0, 0.25}, {4, -1.0}, {5, -0.75}, {31, 0.5}};

TEST(CodeWidths, AsMeasuredAddUpFromTheMiddle) {
  const CodeWidths widths(kFew_lsb, 6);
  const std::map<std::int32_t, float> expected = {{-32, -0.5f}, {-3, -0.5f}, {-2, 0.0f}, {0, 0.0f},   {1, 0.25f},
                                                  {4, 0.25f},   {5, -0.75f}, {6, -1.5f}, {31, -1.5f}, {32, -1.0f}};
  for (const auto& [code, off_lsb] : expected) EXPECT_EQ(widths.Off_lsb(code), off_lsb) << code;
  EXPECT_EQ(widths.Off_lsb(-100), -0.5f);
  EXPECT_EQ(widths.Off_lsb(100), -1.0f);
}

// The code of a voltage is that between whose edges, written down here, it lies.
TEST(CodeWidths, AsMeasuredGiveEachVoltageItsCode) {
  const CodeWidths widths(kFew_lsb, 6);
  std::vector<double> edge_lsb;  // below codes -31 .. 31
  for (int code = -31; code <= 31; ++code)
    edge_lsb.push_back(code - 0.5 +
                       (code <= -3 ? -0.5 : code <= 0 ? 0.0 : code <= 4 ? 0.25 : code == 5 ? -0.75 : -1.5));
  for (double x_lsb = -33.031; x_lsb < 33.0; x_lsb += 0.11) {
    const auto below = std::count_if(edge_lsb.begin(), edge_lsb.end(), [&](double edge) { return edge <= x_lsb; });
    const std::int32_t code = widths.CodeOf(7, static_cast<float>(x_lsb - 7.0));
    EXPECT_EQ(std::clamp(code, -32, 31), -32 + below) << x_lsb;
    EXPECT_NE(code, 4);  // it is missing
  }
}

TEST(CodeWidths, AreReadFromATableOfWidthsOrOfTheirExcessAndSayWhatIsWrongWithIt) {
  const TemporaryFolder folder;
  const auto read = [&](const std::string& text) { return ReadExcessWidths_lsb(folder.Write("w.csv", text), 6); };
  const std::map<std::int32_t, double> expected = {{-32, 0.25}, {3, -1.0}};
  EXPECT_EQ(read("code,width\n-32,1.25\n3,0\n"), expected);
  EXPECT_EQ(read("# measured\ncode,dnl_lsb\n-32,0.25\n3,-1\n"), expected);
  ExpectRefused(folder.File("w.csv"), [&](const auto& text) { return MessageOf([&] { read(text); }); },
                {{3, "code,width\n1,1\n32,1\n"}, {2, "code,width\n1.5,1\n"}, {3, "code,width\n2,1\n1,1\n"},
                 {2, "code,width\n2,-0.1\n"}, {2, "code,dnl_lsb\n2,-1.1\n"}, {1, "code,width,dnl_lsb\n2,1,0\n"},
                 {1, "code,size\n2,1\n"}, {1, "codes,width\n2,1\n"}});
  EXPECT_KEPT(MessageOf([&] { read("code,width\n"); }));
  const std::string both = "bench = \"rotary_4dof\"\n[adc]\ndnl_lsb = 0.1\ndnl_file = \"a.csv\"\n";
  EXPECT_KEPT(MessageOf([&] { ParseScenario(both, "a.toml", ""); }));
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

/// A mean has a noise of 1.4 uV, and nothing else any.
Scenario WithLittleNoise() {
  Scenario scenario = test::SmallNoiseFree();
  scenario.noise_free = false;
  scenario.environment.sensor_noise_K = 0.0;
  RotarySettings& own = RotaryOf(scenario);
  own.autocollimator.noise_rad = 0.0;
  own.amplifier.noise_V = 0.2e-3;
  own.adc.samples = 20000;
  return scenario;
}

// Random widths, and as measured: every second code is 0.91 LSB too wide and the next 0.89 too narrow: beside the
// steps a gain of 0.99.
TEST(CodeWidths, AreFollowedAlsoAsMeasured) {
  const TemporaryFolder folder;
  std::string table = "code,dnl_lsb\n";
  for (int code = -32768; code < 32768; ++code)
    table += std::to_string(code) + (code % 2 == 0 ? ",0.91\n" : ",-0.89\n");
  Scenario random = WithLittleNoise(), measured = random;
  RotaryOf(random).chain.dnl_lsb = 0.4;
  // Light's noise blurs steps, too.
  RotaryOf(measured).psd_a.bandwidth_Hz = RotaryOf(measured).psd_b.bandwidth_Hz = 1.0;
  RotaryOf(measured).chain.dnl_file = folder.Write("widths.csv", table);
  for (const auto& [scenario, without_V] : {std::pair(random, 10e-6), {measured, 30e-6}}) {
    const test::TwinRun run = test::RunTwin(scenario);
    EXPECT_LT(Left_V(scenario, run.readings), 3e-6);
    Scenario even = scenario;
    RotaryOf(even).chain.dnl_lsb = 0.0;
    RotaryOf(even).chain.dnl_file.clear();
    EXPECT_GT(Left_V(even, run.readings), without_V);
  }
}

}  // namespace
}  // namespace twinbench::sim
