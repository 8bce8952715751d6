#include "hw_bridge/ad/clock_watch.h"

#include <gtest/gtest.h>

#include "twin/core/device_fault.h"

namespace twinbench::hw {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr std::int64_t kSecond_ns = 1'000'000'000;

TEST(ClockWatch, LetsClocksDriftApartByAHundredPpm) {
  ClockWatch watch;
  for (int k = 0; k < 100; ++k) watch.Compare(7 * kSecond_ns + k * (60 * kSecond_ns + 3'000'000), Time(seconds(60 * k)), {});
}

TEST(ClockWatch, CallsAStepOfASecondAFaultAndThenStartsAgain) {
  ClockWatch watch;
  watch.Compare(0, Time(seconds(0)), milliseconds(1));
  try {
    watch.Compare(2 * kSecond_ns, Time(seconds(1)), milliseconds(1));
    FAIL() << "no fault";
  } catch (const DeviceFault& fault) {
    EXPECT_EQ(fault.kind(), FaultKind::kClock);
  }
  watch.Compare(9 * kSecond_ns, Time(seconds(2)), milliseconds(1));
}

TEST(ClockWatch, AllowsForTheTimeThatAsksTake) {
  ClockWatch watch;
  watch.Compare(0, Time(seconds(0)), milliseconds(300));
  watch.Compare(kSecond_ns + kSecond_ns / 4, Time(seconds(1)), milliseconds(1));
}

TEST(ClockWatch, FollowsABenchThatStartsAgain) {
  ClockWatch watch;
  watch.Compare(100 * kSecond_ns, Time(seconds(100)), {});
  watch.Compare(kSecond_ns, Time(seconds(1)), {});
}

}  // namespace
}  // namespace twinbench::hw
