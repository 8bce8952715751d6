#include "hw_bridge/numbers/comedi_numbers.h"

#include <gmock/gmock.h>

#include "tests/core/input_error.h"
#include "tests/hw_ad/backend_test.h"
#include "tests/support/kept_text.h"
#include "twin/core/device_fault.h"
#include "twin/core/errors.h"

/// On libcomedi itself, with the preloaded card of comedi_source_test.cc, whose subdevice 2 has two counters.
namespace twinbench::hw {
namespace {

using testing::DoubleNear, testing::ElementsAre, testing::HasSubstr;

class ComediNumbersTest : public testing::Test {
 protected:
  void SetUp() override {
    if (std::getenv("LD_PRELOAD") == nullptr) GTEST_SKIP() << "needs the preloaded card; ctest brings it";
  }
  void TearDown() override { unsetenv("TWINBENCH_COMEDI_TWIN"); }

  std::vector<double> Read(const std::vector<std::string>& items) {
    const std::string device = test::ComediSettings(served_).device;
    return MakeComediNumbers({.kind = "comedi", .address = "", .device = device, .items = items}, "instrument_1",
                             "bench.toml:7")
        ->Read();
  }

  test::HeldTwin served_{test::RotaryScenario()};
};

TEST_F(ComediNumbersTest, CountersAreReadWithTheSignThatTheyAreSaidToHave) {
  EXPECT_THAT(Read({"2 0", "2 1", "2 1 signed", "2 0 signed"}),
              ElementsAre(1234567.0, 16777216.0 - 42.0, -42.0, 1234567.0));
}

TEST_F(ComediNumbersTest, WhatTheCardHasNotIsRefused) {
  const auto read = [&] { Read({"2 2"}); };
  EXPECT_EQ(test::FaultIn(read), "refused");
  EXPECT_THAT(test::TextOf(read), HasSubstr("no channel 2 of subdevice 2"));
}

TEST_F(ComediNumbersTest, AnItemThatIsNoneIsToldWithItsLine) {
  for (const char* item : {"2", "x 0", "2 0 unsigned", "2 0 signed more", "-1 0", ""}) {
    const std::string refusal = MessageOf([&] { Read({item}); });
    EXPECT_THAT(refusal, testing::StartsWith("bench.toml:7: "));
    EXPECT_KEPT(refusal);
  }
}

}  // namespace
}  // namespace twinbench::hw
