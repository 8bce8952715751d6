#include "hw_bridge/ad/scan_stamps.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace twinbench::hw {
namespace {

std::vector<std::int64_t> Stamps(int scans, double rate_Hz, std::int64_t start_ns = 0) {
  std::vector<std::int64_t> stamps_ns;
  for (int s = 0; s < scans; ++s) stamps_ns.push_back(start_ns + std::llround(s * 1e9 / rate_Hz));
  return stamps_ns;
}

TEST(ScanStamps, OfAWholeBlockHaveNoGap) {
  for (const double rate_Hz : {1.0, 48e3, 62.5e3, 250e3, 1.0 / 3.0}) {
    const StampFindings found = JudgeStamps(Stamps(1000, rate_Hz), rate_Hz);
    EXPECT_EQ(found.lost_scans, 0);
    EXPECT_EQ(found.first_gap, -1);
    EXPECT_EQ(found.first_back, -1);
  }
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
  for (std::size_t s = 0; s < stamps_ns.size(); ++s) {
    stamps_ns[s] += (s % 2 == 0 ? 3900 : 0) + std::llround(static_cast<double>(stamps_ns[s]) * 1e-3);
  }
  EXPECT_EQ(JudgeStamps(stamps_ns, 62.5e3).lost_scans, 0);
  EXPECT_EQ(JudgeStamps(stamps_ns, 62.5e3).first_back, -1);
}

TEST(ScanStamps, ThatGoBackAreNoted) {
  auto stamps_ns = Stamps(100, 62.5e3, 5'000'000'000);
  for (std::size_t s = 40; s < 100; ++s) stamps_ns[s] -= 1'000'000'000;
  EXPECT_EQ(JudgeStamps(stamps_ns, 62.5e3).first_back, 40);
}

TEST(ScanStamps, OfOneScanOrNoneSayNothing) {
  EXPECT_EQ(JudgeStamps({}, 62.5e3).lost_scans, 0);
  EXPECT_EQ(JudgeStamps(Stamps(1, 62.5e3), 62.5e3).lost_scans, 0);
}

}  // namespace
}  // namespace twinbench::hw
