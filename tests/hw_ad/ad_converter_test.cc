#include "hw_bridge/ad/ad_converter.h"

#include "hw_bridge/ad/negotiation.h"
#include "tests/fuzz/plain_bench.h"
#include "tests/hw_ad/blocks.h"
#include "tests/support/faults.h"
#include "tests/support/kept_text.h"
#include "twin/core/device_fault.h"

namespace twinbench::hw {
namespace {

using test::kNoise_V;
using ::testing::AllOf, ::testing::HasSubstr;

/// A card whose answers and blocks a test writes down.
class ScriptedSource : public AdSource {
 public:
  struct Script {
    ScanSpec asked;             // what Configure got
    std::optional<double> rate_Hz;  // answers instead of what was asked
    int bits = 16;
    std::optional<double> range_V;
    double zero_V = 0.0;
    std::string serial = "S1";
    std::optional<CalibrationPolynomial> calibration;
    AdBlock block;
  };
  explicit ScriptedSource(Script& script) : script_(script) {}

  Negotiated Configure(const ScanSpec& spec) override {
    script_.asked = spec;
    Negotiated n;
    n.actual = spec;
    n.actual.scan_rate_Hz = script_.rate_Hz.value_or(spec.scan_rate_Hz);
    n.bits = script_.bits;
    n.identity = "scripted card";
    n.serial = script_.serial;
    n.calibrated = script_.calibration.has_value();
    for (auto& channel : n.actual.channels) {
      channel.range_V = script_.range_V.value_or(channel.range_V);
      n.calibration.push_back(script_.calibration.value_or(CalibrationPolynomial{0.0, {script_.zero_V, 1.0}}));
      n.skew_s.push_back(0.0);
    }
    return n;
  }
  AdBlock Take(int /*scans*/) override { return script_.block; }

 private:
  Script& script_;
};

AdSettings Settings(const std::string& kind) {
  AdSettings settings;
  settings.kind = kind;
  settings.channels = {"a", "b", "c", "d"};
  return settings;
}

class AdConverterTest : public ::testing::Test {
 protected:
  std::unique_ptr<AdFrontEnd> Make() {
    return MakeAdConverter(std::make_unique<ScriptedSource>(script_), settings_, adc_, clock_, kNoise_V);
  }
  /// The fault that making the converter ends in.
  DeviceFault Refusal() {
    return test::FaultOf([this] { Make(); }).value();
  }

  AdSettings settings_ = Settings("iio");
  AdcSettings adc_;
  ScriptedSource::Script script_;
  fuzz::PlainClock clock_;
};

TEST_F(AdConverterTest, AsksForTheChannelsInScanOrderAndGivesThemInChannelOrder) {
  adc_.scan_list = {"psd_b_x", "psd_a_x", "psd_b_y", "psd_a_y"};
  script_.block.raw = {30, 10, 40, 20, 31, 11, 41, 21};
  const Acquisition block = Make()->Acquire(2, false);
  std::vector<std::string> asked;
  for (const ScanChannel& channel : script_.asked.channels) asked.push_back(channel.id);
  EXPECT_EQ(asked, (std::vector<std::string>{"c", "a", "d", "b"}));
  EXPECT_EQ(block.raw, (std::vector<std::int16_t>{10, 20, 30, 40, 11, 21, 31, 41}));
}

TEST_F(AdConverterTest, HasNoNumbersWithoutLightButKeepsTheCounts) {
  script_.block.raw.assign(400, 0);
  for (const auto& [light, status] :
       {std::pair{"no_light", ReadingStatus::kNoLight}, std::pair{"clipped_spot", ReadingStatus::kClippedSpot}}) {
    script_.block.light = light;
    const Acquisition block = Make()->Acquire(100, false);
    EXPECT_EQ(block.status, status);
    EXPECT_EQ(block.n_samples, 0) << "as the twin has it";
    EXPECT_EQ(block.raw.size(), 400u);
    for (const ChannelBlock& channel : block.channel)
      EXPECT_TRUE(std::isnan(channel.mean_V) && std::isnan(channel.max_V));
  }
}

TEST_F(AdConverterTest, CountsScansByTheCardsClockWithThoseBetweenTheBlocksAndThoseTakenIfItStampsNone) {
  auto converter = Make();
  script_.block.raw = test::RawBlock(test::FourLevels(kNoise_V), 100, 1);
  script_.block.stamp.device_ns = 5'000'000'000;
  EXPECT_EQ(converter->Acquire(100, false).stamp.first_scan, 0);
  clock_.Wait(std::chrono::seconds(2));
  script_.block.stamp.device_ns = 7'000'000'000;
  EXPECT_EQ(converter->Acquire(100, false).stamp.first_scan, 125000);  // 2 s of 62 500 scans/s
  script_.block.stamp = {};
  auto unstamped = Make();
  EXPECT_EQ(unstamped->Acquire(100, false).stamp.first_scan, 0);
  EXPECT_EQ(unstamped->Acquire(100, false).stamp.first_scan, 100);
}

TEST_F(AdConverterTest, DescribesEveryChannelForTheRecord) {
  const auto lines = DescribeChannels(Make()->Actual());
  ASSERT_EQ(lines.size(), 4u);
  EXPECT_THAT(lines[2], AllOf(HasSubstr("c: ±10 V"), HasSubstr("ground"), HasSubstr("0, 1"))) << lines[2];
}

TEST_F(AdConverterTest, RefusesAnotherRateResolutionRangeOrZeroNamingBoth) {
  script_.rate_Hz = 62.4e3;
  EXPECT_EQ(Refusal().kind(), FaultKind::kRefused);
  EXPECT_KEPT(Refusal().what());
  settings_.rate_tolerance = 2e-3;
  EXPECT_EQ(Make()->Actual().actual.scan_rate_Hz, 62.4e3) << "within the tolerance: taken, and told";
  script_.rate_Hz.reset();
  script_.bits = 12;
  EXPECT_KEPT(Refusal().what());
  script_.bits = 16;
  script_.range_V = 5.0;
  EXPECT_KEPT(Refusal().what());
  script_.range_V.reset();
  script_.zero_V = 0.1;
  EXPECT_KEPT(Refusal().what());
}

TEST_F(AdConverterTest, RefusesAnotherCardOrOneThatDoesNotSay) {
  settings_.serial = "S2";
  for (const char* serial : {"S1", ""}) {
    script_.serial = serial;
    EXPECT_EQ(Refusal().kind(), FaultKind::kIdentity);
    EXPECT_KEPT(Refusal().what());
  }
  script_.serial = "S2";
  EXPECT_THAT(Make()->Identity(), HasSubstr("S2"));
}

TEST_F(AdConverterTest, MeasuresWithTheCalibrationOfTheCard) {
  script_.range_V = 10.001;  // what is nominal does not count then
  script_.calibration = CalibrationPolynomial{100.0, {0.5, 1e-3}};
  script_.block.raw = {100, 200, 300, 400, 102, 202, 302, 402};
  const Acquisition block = Make()->Acquire(2, false);
  EXPECT_NEAR(block.channel[1].mean_V, 0.5 + 0.101, 1e-15);
  EXPECT_NEAR(block.channel[3].std_V, 1e-3 * std::sqrt(2.0), 1e-15);
}

TEST(MakeAdConverter, RefusesABackendThatThereIsNot) {
  fuzz::PlainClock clock;
  EXPECT_THROW(MakeAdConverter(Settings("telepathy"), {}, clock), InputError);
}

}  // namespace
}  // namespace twinbench::hw
