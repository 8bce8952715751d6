#include "hw_bridge/numbers/iio_numbers.h"

#include <gmock/gmock.h>

#include <regex>

#include "tests/core/input_error.h"
#include "tests/hw_ad/held_twin.h"
#include "tests/hw_control/faults.h"
#include "tests/support/kept_text.h"
#include "tests/support/rotary_scenario.h"
#include "twin/core/device_fault.h"
#include "twin/core/errors.h"

/// By libiio, of the devices that a served rotary bench shows.
namespace twinbench::hw {
namespace {

using testing::ElementsAre;

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
  EXPECT_THAT(first, ElementsAre(testing::Gt(1000.0), testing::Gt(0.0)));
  EXPECT_EQ(source->Read(), first);
}

TEST_F(IioNumbersTest, WhatThereIsNotIsRefusedByName) {
  for (const auto& [device, item] :
       {std::pair{"psd-adc16", "voltage0 colour"}, std::pair{"psd-adc16", "voltage9 scale"},
        std::pair{"counter", "count0 raw"}}) {
    const auto read = [&] { Source(device, {item})->Read(); };
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
