#include <asio.hpp>
#include <regex>

#include "hw_bridge/numbers/number_drivers.h"
#include "tests/core/input_error.h"
#include "tests/hw_ad/backend_test.h"
#include "tests/support/kept_text.h"

/// By libiio, of the devices that a served rotary bench shows.
namespace twinbench::hw {
namespace {

using test::FaultIn, test::HeldTwin, test::IioSettings, test::ServedCard, test::Struck;

TEST(IioSource, GivesTheServedTwinsOwnBlocksAlsoAtAnotherRateRangeAndResolution) {
  ServedCard(IioSettings).ExpectTheTwinsOwnBlocks();
  const Scenario other = Altered(test::RotaryScenario(), {"adc.rate_kHz=192", "adc.range_V=5", "adc.bits=12"});
  ServedCard(IioSettings, other).ExpectTheTwinsOwnBlocks();  // a scan takes 20833.3 ns
}

TEST(IioSource, TellsWhatTheCardIs) {
  const ServedCard card(IioSettings);
  const Negotiated actual = card.Open()->Actual();
  EXPECT_EQ(actual.bits, 16);
  EXPECT_EQ(actual.actual.scan_rate_Hz, 62.5e3);
  EXPECT_DOUBLE_EQ(actual.actual.channels[2].range_V, 10.0);
  EXPECT_DOUBLE_EQ(actual.skew_s[3], 12e-6);
  EXPECT_TRUE(actual.stamps_scans);
  EXPECT_FALSE(actual.serial.empty());
}

class IioFault : public ::testing::TestWithParam<Struck> {};

TEST_P(IioFault, IsNamedAndTheNextBlockIsWhole) {
  ServedCard(IioSettings).ExpectNamedAndTheNextBlocksWhole(GetParam());
}

INSTANTIATE_TEST_SUITE_P(Every, IioFault,
                         ::testing::Values(Struck{"drop", "dropped"}, Struck{"stall", "timeout"},
                                           Struck{"short", "dropped"}, Struck{"error", "dropped"},
                                           Struck{"gap", "gap"}, Struck{"slip", "channel_slip"},
                                           Struck{"stuck", "stuck"}, Struck{"float", "signal_lost"}),
                         Struck::Name);

TEST(IioSource, ComesBackToACardThatWasSwitchedOffAndOn) {
  Scenario scenario = test::RotaryScenario();
  auto served = std::make_unique<HeldTwin>(scenario);
  const int port = served->iiod_port();
  const ServedCard clock(IioSettings, scenario);
  const auto card = clock.OpenWith(IioSettings(*served));
  served.reset();
  EXPECT_EQ(FaultIn([&] { card->Acquire(100, true); }), "dropped");
  EXPECT_EQ(FaultIn([&] { card->Acquire(100, true); }), "dropped") << "still off";
  served = std::make_unique<HeldTwin>(scenario, port);
  EXPECT_EQ(card->Acquire(100, true).status, ReadingStatus::kOk);
  served.reset();
  scenario.seed = 2;
  served = std::make_unique<HeldTwin>(scenario, port);
  EXPECT_EQ(FaultIn([&] { card->Acquire(100, true); }), "dropped");
  EXPECT_EQ(FaultIn([&] { card->Acquire(100, true); }), "identity") << "another serial number is another card";
}

TEST(IioSource, RefusesADeviceAChannelALightOrAServerThatThereIsNot) {
  const ServedCard card(IioSettings);
  EXPECT_EQ(card.FaultWith([](AdSettings& s) { s.device = "ad7606"; }), "identity");
  EXPECT_EQ(card.FaultWith([](AdSettings& s) { s.channels[2] = "voltage9"; }), "refused");
  EXPECT_EQ(card.FaultWith([](AdSettings& s) { s.light = "lamp"; }), "protocol");
  EXPECT_EQ(card.FaultWith([](AdSettings& s) { s.serial = "another"; }), "identity");
  EXPECT_EQ(card.FaultWith([](AdSettings& s) { s.uri = "ip:127.0.0.1:1"; }), "dropped") << "nobody listens";
}

TEST(IioSource, RefusesARateThatTheCardCannotDo) {
  ServedCard card(IioSettings);
  RotaryOf(card.scenario).adc.rate_Hz = 200e3;
  const auto open = [&] { card.Open(); };
  EXPECT_EQ(FaultIn(open), "refused");
  EXPECT_THAT(test::TextOf(open), ::testing::AllOf(::testing::HasSubstr("62500"), ::testing::HasSubstr("50000")));
}

TEST(IioSource, GivesUpAServerThatTakesCallsAndSaysNothing) {
  asio::io_context io;
  asio::ip::tcp::acceptor silent(io, {asio::ip::make_address("127.0.0.1"), 0});
  ServedCard card(IioSettings);
  card.settings.uri = "ip:127.0.0.1:" + std::to_string(silent.local_endpoint().port());
  const auto start = std::chrono::steady_clock::now();
  EXPECT_EQ(FaultIn([&] { card.Open(); }), "timeout");
  EXPECT_LT(test::SecondsSince(start), 1.0);
}

// Single numbers instead of blocks.

class IioNumbersTest : public testing::Test {
 protected:
  std::unique_ptr<NumberSource> Source(const std::string& device, const std::vector<std::string>& items) {
    const std::string uri = "ip:127.0.0.1:" + std::to_string(served_.iiod_port());
    return MakeIioNumbers({.kind = "iio", .address = "", .uri = uri, .device = device, .items = items},
                          "instrument_1", "bench.toml:7");
  }
  test::HeldTwin served_{test::RotaryScenario()};
};

TEST_F(IioNumbersTest, AttributesOfADeviceAndOfItsChannelsAreRead) {
  const auto source = Source("psd-adc16", {"sampling_frequency", "voltage0 scale"});
  const std::vector<double> first = source->Read();
  EXPECT_THAT(first, testing::ElementsAre(testing::Gt(1000.0), testing::Gt(0.0)));
  EXPECT_EQ(source->Read(), first);
}

TEST_F(IioNumbersTest, WhatThereIsNotIsRefusedByName) {
  for (const auto& [device, item] :
       {std::pair{"psd-adc16", "voltage0 colour"}, std::pair{"psd-adc16", "voltage9 scale"},
        std::pair{"counter", "count0 raw"}}) {
    const auto read = [this, device = device, item = item] { Source(device, {item})->Read(); };
    EXPECT_EQ(test::KindOf(read), FaultKind::kRefused);
    EXPECT_KEPT(std::regex_replace(test::TextOf(read), std::regex("127.0.0.1:\\d+"), "<address>"));
  }
}

TEST_F(IioNumbersTest, AnItemThatIsNoneIsToldWithItsLine) {
  for (const char* item : {"", "voltage0 raw more"}) {
    const std::string refusal = MessageOf([&] { Source("psd-adc16", {item}); });
    EXPECT_THAT(refusal, testing::StartsWith("bench.toml:7: "));
    EXPECT_KEPT(refusal);
  }
}

}  // namespace
}  // namespace twinbench::hw
