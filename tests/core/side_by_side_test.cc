#include "twin/core/side_by_side.h"

#include <atomic>

namespace twinbench {
namespace {

TEST(SideBySide, DoesEachPieceOnceByAnyNumberOfThreads) {
  for (const int threads : {1, 2, 7, 100}) {
    std::vector<int> times(50);
    SideBySide(50, threads, [&](int k) { ++times[static_cast<std::size_t>(k)]; });
    EXPECT_EQ(times, std::vector<int>(50, 1)) << threads;
  }
  SideBySide(0, 3, [](int) { FAIL() << "there is no piece"; });
}

TEST(SideBySide, ThrowsWhatAPieceThrowsAndBeginsNoMore) {
  std::atomic<int> begun = 0;
  const auto work = [&](int) {
    if (++begun > 2) throw std::runtime_error("third");
  };
  EXPECT_THROW(SideBySide(1000, 2, work), std::runtime_error);
  EXPECT_LT(begun, 10);
}

}  // namespace
}  // namespace twinbench
