#include "hw_bridge/numbers/iio_numbers.h"

#include <gmock/gmock.h>

#include "tests/hw_ad/held_twin.h"
#include "tests/support/rotary_scenario.h"
#include "twin/core/device_fault.h"
#include "twin/core/errors.h"

/// By libiio, of the devices that a served rotary bench shows.
namespace twinbench::hw {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

class IioNumbersTest : public testing::Test {
 protected:
  std::unique_ptr<NumberSource> Source(const std::string& device, const std::vector<std::string>& items) {
    return MakeIioNumbers({.kind = "iio",
                           .address = "",
                           .uri = "ip:127.0.0.1:" + std::to_string(served_.iiod_port()),
                           .device = device,
                           .items = items},
                          "instrument_1", "bench.toml:7");
  }
  std::string Refusal(const std::string& device, const std::string& item) {
    try {
      Source(device, {item})->Read();
    } catch (const DeviceFault& fault) {
      EXPECT_EQ(fault.kind(), FaultKind::kRefused);
      return fault.what();
    }
    return "";
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
  EXPECT_THAT(Refusal("psd-adc16", "voltage0 colour"), HasSubstr("psd-adc16 has no \"voltage0 colour\""));
  EXPECT_THAT(Refusal("psd-adc16", "voltage9 scale"), HasSubstr("has no \"voltage9 scale\""));
  EXPECT_THAT(Refusal("counter", "count0 raw"), HasSubstr("there is no device \"counter\""));
}

TEST_F(IioNumbersTest, AnItemThatIsNoneIsToldWithItsLine) {
  for (const char* item : {"", "voltage0 raw more"}) {
    try {
      Source("psd-adc16", {item});
      FAIL() << item;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), AllOf(HasSubstr("bench.toml:7"), HasSubstr("is no attribute"))) << item;
    }
  }
}

}  // namespace
}  // namespace twinbench::hw
