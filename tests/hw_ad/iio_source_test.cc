#include "hw_bridge/ad/iio_source.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <asio.hpp>

#include "tests/hw_ad/backend_test.h"

namespace twinbench::hw {
namespace {

using test::FaultIn, test::HeldTwin, test::IioSettings, test::ServedCard, test::Struck;

TEST(IioSource, GivesTheServedTwinsOwnBlocksAlsoAtAnotherRateRangeAndResolution) {
  ServedCard(IioSettings).ExpectTheTwinsOwnBlocks();
  Scenario scenario = test::RotaryScenario();
  RotaryOf(scenario).adc.rate_Hz = 192e3;  // a scan takes 20833.3 ns
  RotaryOf(scenario).adc.range_V = 5.0;
  RotaryOf(scenario).adc.bits = 12;
  ServedCard(IioSettings, scenario).ExpectTheTwinsOwnBlocks();
}

TEST(IioSource, SaturatesAndLosesTheLightAsTheTwinDoes) {
  Scenario scenario = test::RotaryScenario();
  RotaryOf(scenario).amplifier.offset_V[1] = 11.0;
  ServedCard card(IioSettings, scenario);
  card.ExpectTheTwinsOwnBlocks();
  card.ExpectTheLightIsLostAsTheTwinLosesIt(*card.Open());
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
                         [](const auto& instance) { return std::string(instance.param.injected); });

TEST(IioSource, HasAStatusForSaturationAndDarknessAndMeasuresUnderHum) {
  const ServedCard card(IioSettings);
  const auto opened = card.Open();
  card.served.Inject("saturate");
  const Acquisition saturated = opened->Acquire(100, true);
  EXPECT_EQ(saturated.status, ReadingStatus::kSaturated);
  EXPECT_EQ(saturated.saturated_mask, 1);
  EXPECT_TRUE(std::isnan(saturated.channel[0].mean_V));
  EXPECT_FALSE(std::isnan(saturated.channel[1].mean_V));
  card.served.Inject("no_light");
  EXPECT_EQ(opened->Acquire(100, true).status, ReadingStatus::kNoLight);
  card.served.Inject("hum");
  EXPECT_EQ(opened->Acquire(6250, true).status, ReadingStatus::kOk);
  // 0.1 V, with a standard uncertainty of 6 mV sqrt(2 / 6250): five of them.
  EXPECT_NEAR(opened->Findings().mains_lsb[0] * 10.0 / 32768.0, 0.1, 6e-4);
}

TEST(IioSource, NoticesThatTheClockOfTheCardJumps) {
  const ServedCard card(IioSettings);
  const auto opened = card.Open();
  opened->Acquire(100, true);
  card.served.Ask("SIM:FAUL clock,step;*OPC?");
  EXPECT_EQ(FaultIn([&] { opened->Acquire(100, true); }), "clock");
  EXPECT_EQ(FaultIn([&] { opened->Acquire(100, true); }), "clock") << "it was one block, and the clock jumps back";
  EXPECT_EQ(opened->Acquire(100, true).status, ReadingStatus::kOk);
}

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

}  // namespace
}  // namespace twinbench::hw
