#include "hw_bridge/ad/clock_watch.h"
#include "hw_bridge/ad/scan_stamps.h"
#include "tests/support/faults.h"

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

std::vector<std::int64_t> Stamps(int scans, double rate_Hz, std::int64_t start_ns = 0) {
  std::vector<std::int64_t> stamps_ns;
  for (int s = 0; s < scans; ++s) stamps_ns.push_back(start_ns + std::llround(s * 1e9 / rate_Hz));
  return stamps_ns;
}

TEST(ScanStamps, OfAWholeBlockHaveNoGapAndOfOneScanOrNoneSayNothing) {
  for (const double rate_Hz : {1.0, 48e3, 62.5e3, 250e3, 1.0 / 3.0}) {
    const StampFindings found = JudgeStamps(Stamps(1000, rate_Hz), rate_Hz);
    EXPECT_EQ(found.lost_scans, 0);
    EXPECT_EQ(found.first_gap, -1);
    EXPECT_EQ(found.first_back, -1);
  }
  EXPECT_EQ(JudgeStamps({}, 62.5e3).lost_scans, 0);
  EXPECT_EQ(JudgeStamps(Stamps(1, 62.5e3), 62.5e3).lost_scans, 0);
}

TEST(ScanStamps, CountWhatIsMissingAndWhere) {
  auto stamps_ns = Stamps(1000, 62.5e3);
  stamps_ns.erase(stamps_ns.begin() + 700, stamps_ns.begin() + 705);
  stamps_ns.erase(stamps_ns.begin() + 300);
  const StampFindings found = JudgeStamps(stamps_ns, 62.5e3);
  EXPECT_EQ(found.lost_scans, 6);
  EXPECT_EQ(found.first_gap, 300);
}

TEST(ScanStamps, MayJitterByLessThanHalfAPeriodAndRunFast) {
  auto stamps_ns = Stamps(1000, 62.5e3);
  for (std::size_t s = 0; s < stamps_ns.size(); ++s)
    stamps_ns[s] += (s % 2 == 0 ? 3900 : 0) + std::llround(static_cast<double>(stamps_ns[s]) * 1e-3);
  EXPECT_EQ(JudgeStamps(stamps_ns, 62.5e3).lost_scans, 0);
  EXPECT_EQ(JudgeStamps(stamps_ns, 62.5e3).first_back, -1);
}

TEST(ScanStamps, ThatGoBackAreNoted) {
  auto stamps_ns = Stamps(100, 62.5e3, 5'000'000'000);
  for (std::size_t s = 40; s < 100; ++s) stamps_ns[s] -= 1'000'000'000;
  EXPECT_EQ(JudgeStamps(stamps_ns, 62.5e3).first_back, 40);
}

}  // namespace
}  // namespace twinbench::hw
