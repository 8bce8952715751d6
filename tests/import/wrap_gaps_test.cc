#include <fmt/format.h>
#include <gmock/gmock.h>

#include <numeric>

#include "tests/import/importing.h"
#include "tests/support/kept_text.h"

/// Tables that a firmware interpolated without regard to the wrap.
namespace twinbench::imports {
namespace {

using testing::HasSubstr, testing::Not;

constexpr int kStops = 200, kWrapsAt = 120;  // 1.8 deg a row

/// From 0 to 360 or from -180 to 180, with `between` rows on the straight line from one end of the wrap to the other.
std::vector<double> Interpolated(int between, double lowest) {
  std::vector<double> x;
  for (int i = 0; i < kStops; ++i) x.push_back(lowest + 360.0 * (i + kStops - kWrapsAt < kStops ? i + kStops - kWrapsAt : i - kWrapsAt) / kStops);
  const std::size_t first = kWrapsAt - 1, last = first + static_cast<std::size_t>(between) + 1;
  for (std::size_t i = first + 1; i < last; ++i)
    x[i] = x[first] + (x[last] - x[first]) * static_cast<double>(i - first) / static_cast<double>(last - first);
  return x;
}

std::string Table(const std::vector<double>& reference, const std::vector<double>& measured) {
  std::string text = "reference [deg],measured [deg]\n";
  for (std::size_t i = 0; i < reference.size(); ++i) text += fmt::format("{:.2f},{:.3f}\n", reference[i], measured[i]);
  return text;
}

std::vector<double> RoundOnce() {
  std::vector<double> x(kStops);
  std::iota(x.begin(), x.end(), 0.0);
  for (double& one : x) one *= 1.8;
  return x;
}

TEST_F(Importing, LeavesOutValuesBetweenTheEndsOfAWrap) {
  for (const int between : {1, 2, 5}) {
    for (const double lowest : {0.0, -180.0}) {
      const std::vector<double> broken = Interpolated(between, lowest);
      for (const bool in_reference : {true, false}) {
        const Imported imported = Take(in_reference ? Table(broken, RoundOnce()) : Table(RoundOnce(), broken));
        EXPECT_EQ(std::ssize(imported.readings), kStops - between) << imported.story;
        EXPECT_LT(Worst_deg(imported.readings), 0.01) << "the rounding of the file";
      }
    }
  }
  EXPECT_KEPT(Take(Table(Interpolated(5, 0.0), RoundOnce())).story);
}

TEST_F(Importing, LeavesOutValuesBetweenTheEndsOfAFallingWrap) {
  std::vector<double> falling = Interpolated(3, 0.0), other = RoundOnce();
  std::ranges::reverse(falling);
  std::ranges::reverse(other);
  EXPECT_EQ(std::ssize(Take(Table(falling, other)).readings), kStops - 3);
}

/// An axis that drives back to its start in a few rows was there: its device shows it.
TEST_F(Importing, KeepsAFastWayBack) {
  std::vector<double> there_and_back = RoundOnce();
  for (const double x : {300.0, 200.0, 100.0}) there_and_back.push_back(x);
  for (const double x : RoundOnce()) there_and_back.push_back(x);
  const Imported imported = Take(Table(there_and_back, there_and_back));
  EXPECT_EQ(std::ssize(imported.readings), 2 * kStops + 3);
  EXPECT_THAT(imported.story, Not(HasSubstr("interpolated")));
}

}  // namespace
}  // namespace twinbench::imports
