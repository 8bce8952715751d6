#include "hw_bridge/ad/iio_source.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <asio.hpp>
#include <chrono>
#include <thread>

#include "tests/hw_ad/backend_test.h"
#include "tests/support/rotary_scenario.h"
#include "twin/benches/rotary_4dof/settings.h"

namespace twinbench::hw {
namespace {

using test::FaultIn;
using test::HeldTwin;
using test::IioSettings;
using Stopwatch = std::chrono::steady_clock;

double SecondsSince(Stopwatch::time_point start) {
  return std::chrono::duration<double>(Stopwatch::now() - start).count();
}

std::unique_ptr<AdFrontEnd> Open(const HeldTwin& served, const Scenario& scenario, const AdSettings& settings) {
  return MakeAdConverter(settings, RotaryOf(scenario).adc, served, RotaryOf(scenario).amplifier.noise_V);
}

TEST(IioSource, GivesTheServedTwinsOwnBlocks) {
  const Scenario scenario = test::RotaryScenario();
  HeldTwin served(scenario);
  const auto card = Open(served, scenario, IioSettings(served));
  test::ExpectTheTwinsOwnBlocks(*card, served, scenario);
}

TEST(IioSource, GivesTheTwinsBlocksAtAnotherRateRangeAndResolution) {
  Scenario scenario = test::RotaryScenario();
  RotaryOf(scenario).adc.rate_Hz = 192e3;  // a scan takes 20833.3 ns
  RotaryOf(scenario).adc.range_V = 5.0;
  RotaryOf(scenario).adc.bits = 12;
  HeldTwin served(scenario);
  const auto card = Open(served, scenario, IioSettings(served));
  test::ExpectTheTwinsOwnBlocks(*card, served, scenario);
}

TEST(IioSource, SaturatesAndLosesTheLightAsTheTwinDoes) {
  Scenario scenario = test::RotaryScenario();
  RotaryOf(scenario).amplifier.offset_V[1] = 11.0;
  HeldTwin served(scenario);
  const auto card = Open(served, scenario, IioSettings(served));
  test::ExpectTheTwinsOwnBlocks(*card, served, scenario);
  served.Ask("GON:MOVE 10800,0;*OPC?");  // 13 mm on PSDs that reach 5 mm
  sim::Twin twin(scenario);
  twin.Bench().goniometer.MoveTo(3.0 * units::deg, 0.0);
  EXPECT_EQ(card->Acquire(100, true).status, twin.Bench().adc.Acquire(100, true).status);
}

TEST(IioSource, TellsWhatTheCardIs) {
  const Scenario scenario = test::RotaryScenario();
  HeldTwin served(scenario);
  const auto card = Open(served, scenario, IioSettings(served));
  EXPECT_EQ(card->Actual().bits, 16);
  EXPECT_EQ(card->Actual().actual.scan_rate_Hz, 62.5e3);
  EXPECT_DOUBLE_EQ(card->Actual().actual.channels[2].range_V, 10.0);
  EXPECT_DOUBLE_EQ(card->Actual().skew_s[3], 12e-6);
  EXPECT_TRUE(card->Actual().stamps_scans);
  EXPECT_FALSE(card->Actual().serial.empty());
}

// --- faults: each by its name, and the block after it is as good as any ---

struct Struck {
  const char* injected;
  const char* fault;
};

class IioFault : public ::testing::TestWithParam<Struck> {};

TEST_P(IioFault, IsNamedAndTheNextBlockIsWhole) {
  const Scenario scenario = test::RotaryScenario();
  HeldTwin served(scenario);
  const auto card = Open(served, scenario, IioSettings(served));
  served.Ask("GON:MOVE 150,80;*OPC?");
  card->Acquire(100, true);
  for (int round = 0; round < 2; ++round) {
    served.Inject(GetParam().injected);
    const auto start = Stopwatch::now();
    EXPECT_EQ(FaultIn([&] { card->Acquire(200, true); }), GetParam().fault);
    EXPECT_LT(SecondsSince(start), 1.0) << "our deadline is 0.5 s; libiio's would be 5 or 10 s";
    // A second block is no surprise either: the clocks are compared anew.
    for (int k = 0; k < 2; ++k) {
      const Acquisition after = card->Acquire(200, true);
      EXPECT_EQ(after.status, ReadingStatus::kOk);
      EXPECT_EQ(after.raw.size(), 800u);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Every, IioFault,
                         ::testing::Values(Struck{"drop", "dropped"}, Struck{"stall", "timeout"},
                                           Struck{"short", "dropped"}, Struck{"error", "dropped"},
                                           Struck{"gap", "gap"}, Struck{"slip", "channel_slip"},
                                           Struck{"stuck", "stuck"}, Struck{"float", "signal_lost"}),
                         [](const auto& instance) { return std::string(instance.param.injected); });

TEST(IioSource, HasAStatusForSaturationAndDarknessAndMeasuresUnderHum) {
  const Scenario scenario = test::RotaryScenario();
  HeldTwin served(scenario);
  const auto card = Open(served, scenario, IioSettings(served));
  served.Inject("saturate");
  const Acquisition saturated = card->Acquire(100, true);
  EXPECT_EQ(saturated.status, ReadingStatus::kSaturated);
  EXPECT_EQ(saturated.saturated_mask, 1);
  EXPECT_TRUE(std::isnan(saturated.channel[0].mean_V));
  EXPECT_FALSE(std::isnan(saturated.channel[1].mean_V));
  served.Inject("no_light");
  EXPECT_EQ(card->Acquire(100, true).status, ReadingStatus::kNoLight);
  served.Inject("hum");
  EXPECT_EQ(card->Acquire(6250, true).status, ReadingStatus::kOk);
  // 0.1 V, with a standard uncertainty of 6 mV sqrt(2 / 6250): five of them.
  EXPECT_NEAR(card->Findings().mains_lsb[0] * 10.0 / 32768.0, 0.1, 6e-4);
}

TEST(IioSource, NoticesThatTheClockOfTheCardJumps) {
  const Scenario scenario = test::RotaryScenario();
  HeldTwin served(scenario);
  const auto card = Open(served, scenario, IioSettings(served));
  card->Acquire(100, true);
  served.Ask("SIM:FAUL clock,step;*OPC?");
  EXPECT_EQ(FaultIn([&] { card->Acquire(100, true); }), "clock");
  EXPECT_EQ(card->Acquire(100, true).status, ReadingStatus::kOk);
}

TEST(IioSource, ComesBackToACardThatWasSwitchedOffAndOn) {
  Scenario scenario = test::RotaryScenario();
  auto served = std::make_unique<HeldTwin>(scenario);
  const int port = served->iiod_port();
  HeldTwin clock(scenario);
  const auto card =
      MakeAdConverter(IioSettings(*served), RotaryOf(scenario).adc, clock, RotaryOf(scenario).amplifier.noise_V);
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

// --- what does not answer or is not there ---

TEST(IioSource, RefusesADeviceAChannelOrALightThatThereIsNot) {
  const Scenario scenario = test::RotaryScenario();
  HeldTwin served(scenario);
  AdSettings settings = IioSettings(served);
  settings.device = "ad7606";
  EXPECT_EQ(FaultIn([&] { Open(served, scenario, settings); }), "identity");
  settings = IioSettings(served);
  settings.channels[2] = "voltage9";
  EXPECT_EQ(FaultIn([&] { Open(served, scenario, settings); }), "refused");
  settings = IioSettings(served);
  settings.light = "lamp";
  EXPECT_EQ(FaultIn([&] { Open(served, scenario, settings)->Acquire(10, true); }), "protocol");
  settings = IioSettings(served);
  settings.serial = "another";
  EXPECT_EQ(FaultIn([&] { Open(served, scenario, settings); }), "identity");
}

TEST(IioSource, RefusesARateThatTheCardCannotDo) {
  Scenario scenario = test::RotaryScenario();
  HeldTwin served(scenario);
  RotaryOf(scenario).adc.rate_Hz = 200e3;
  try {
    Open(served, scenario, IioSettings(served));
    FAIL() << "was not refused";
  } catch (const DeviceFault& fault) {
    EXPECT_EQ(fault.kind(), FaultKind::kRefused);
    EXPECT_THAT(fault.what(), ::testing::AllOf(::testing::HasSubstr("62500"), ::testing::HasSubstr("50000")));
  }
}

TEST(IioSource, GivesUpAServerThatTakesCallsAndSaysNothing) {
  asio::io_context io;
  asio::ip::tcp::acceptor silent(io, {asio::ip::make_address("127.0.0.1"), 0});
  const Scenario scenario = test::RotaryScenario();
  HeldTwin served(scenario);
  AdSettings settings = IioSettings(served);
  settings.uri = "ip:127.0.0.1:" + std::to_string(silent.local_endpoint().port());
  const auto start = Stopwatch::now();
  EXPECT_EQ(FaultIn([&] { Open(served, scenario, settings); }), "timeout");
  EXPECT_LT(SecondsSince(start), 1.0);
}

TEST(IioSource, CannotBeOpenedWhereNobodyListens) {
  const Scenario scenario = test::RotaryScenario();
  HeldTwin served(scenario);
  AdSettings settings = IioSettings(served);
  settings.uri = "ip:127.0.0.1:1";
  EXPECT_EQ(FaultIn([&] { Open(served, scenario, settings); }), "dropped");
}

}  // namespace
}  // namespace twinbench::hw
