#include "hw_bridge/ad/clock_watch.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/hw_control/faults.h"

namespace twinbench::hw {
namespace {

using std::chrono::milliseconds, std::chrono::seconds;

constexpr std::int64_t kSecond_ns = 1'000'000'000;

TEST(ClockWatch, LetsClocksDriftApartByAHundredPpmAllowsForTheTimeThatAsksTakeAndFollowsABenchThatStartsAgain) {
  ClockWatch drifting, slow, again;
  for (int k = 0; k < 100; ++k)
    drifting.Compare(7 * kSecond_ns + k * (60 * kSecond_ns + 3'000'000), Time(seconds(60 * k)), {});
  slow.Compare(0, Time(seconds(0)), milliseconds(300));
  slow.Compare(kSecond_ns + kSecond_ns / 4, Time(seconds(1)), milliseconds(1));
  again.Compare(100 * kSecond_ns, Time(seconds(100)), {});
  again.Compare(kSecond_ns, Time(seconds(1)), {});
}

TEST(ClockWatch, CallsAStepOfASecondAFaultAndGoesOnFromThere) {
  ClockWatch watch;
  watch.Compare(0, Time(seconds(0)), milliseconds(1));
  EXPECT_EQ(test::KindOf([&] { watch.Compare(9 * kSecond_ns, Time(seconds(1)), milliseconds(1)); }),
            FaultKind::kClock);
  watch.Compare(10 * kSecond_ns, Time(seconds(2)), milliseconds(1));
}

TEST(ClockWatch, BelievesNoBlockOfAClockThatStands) {
  ClockWatch watch;
  watch.Compare(0, Time(seconds(0)), milliseconds(1));
  for (int k = 1; k < 4; ++k)
    EXPECT_EQ(test::KindOf([&] { watch.Compare(0, Time(seconds(k)), milliseconds(1)); }), FaultKind::kClock) << k;
}

TEST(ClockWatch, TellsHowFastTheCardsClockGoes) {
  ClockWatch watch;
  EXPECT_TRUE(std::isnan(watch.DriftSoFar().ppm));
  for (int k = 0; k <= 60; ++k)  // 25 ppm fast: 1.5 ms a minute
    watch.Compare(k * (60 * kSecond_ns + 1'500'000), Time(seconds(60 * k)), milliseconds(12));
  const ClockWatch::Drift drift = watch.DriftSoFar();
  EXPECT_NEAR(drift.ppm, 25.0, 1e-9);
  // Two latencies of up to 12 ms, each rectangular, over an hour.
  EXPECT_NEAR(drift.u_ppm, 1e6 * std::sqrt(2.0) * 12e-3 / std::sqrt(12.0) / 3600.0, 1e-9);
  watch.Forget();
  watch.Compare(0, Time(seconds(4000)), {});
  EXPECT_TRUE(std::isnan(watch.DriftSoFar().ppm)) << "a card that came back begins anew";
}

}  // namespace
}  // namespace twinbench::hw
