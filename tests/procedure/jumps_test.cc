#include "twin/procedure/jumps.h"

#include <gtest/gtest.h>

#include <cmath>

#include "twin/core/bench_format.h"
#include "twin/core/device_fault.h"

namespace twinbench::procedure {
namespace {

constexpr double kNoiseOfOne = 1e-7, kJump = 1e-5;
constexpr int kPlaces = 8;

ClaimedColumn ClaimOf(const char* bench, const char* name) {
  const auto& columns = FormatOf(bench).columns;
  return {.column = *std::ranges::find(columns, name, &ReadingColumn::name), .noise = kNoiseOfOne, .is_of_place = true};
}

const ClaimedColumn& X() {
  static const ClaimedColumn claim = ClaimOf("turntable_autocollimator", "autocollimator_x_arcsec");
  return claim;
}

/// Eight positions there and back and so on, of a curve and a reversal of 2 um that is not quite the same everywhere.
Reading NumberOf(int k) {
  Reading r;
  r.reading = k, r.pass = k / kPlaces, r.direction = r.pass % 2 == 0 ? 1 : -1;
  r.position = r.direction > 0 ? k % kPlaces : kPlaces - 1 - k % kPlaces;
  r.autocollimator_yaw_rad = 3e-5 * std::sin(r.position) + r.pass % 2 * (2e-6 + 2e-7 * std::cos(r.position));
  return r;
}

/// x jumps before the n-th of all. How many pass.
int PassUntilNoticed(int n, double jump_rad) {
  std::vector<Reading> kept;
  for (int k = 0; k < 2 * kPlaces; ++k) {
    Reading r = NumberOf(k);
    if (k >= n) r.autocollimator_yaw_rad += jump_rad;
    try {
      RequireNoJump({X()}, r, kept);
    } catch (const DeviceFault&) {
      return k;
    }
    kept.push_back(r);
  }
  return 2 * kPlaces;
}

TEST(RequireNoJump, WhatPassesDifferByIsTheSameBeforeAndBehindEachReading) {
  EXPECT_EQ(PassUntilNoticed(16, kJump), 16);
  EXPECT_EQ(PassUntilNoticed(8, kJump), 16);  // between the passes: it may be a reversal
  EXPECT_EQ(PassUntilNoticed(4, kJump), 13);  // in the first: behind two places of the second on either side
  EXPECT_EQ(PassUntilNoticed(10, kJump), 11);
  EXPECT_EQ(PassUntilNoticed(10, -kJump), 11);
  EXPECT_EQ(PassUntilNoticed(4, 1e-6), 16);  // 10 times the noise
}

using ShownLater = std::function<double(double k)>;  // by how much x is another at the k-th reading

/// Four passes. Numbers of the readings behind which the axes come again, and of that which ended it.
std::string Closed(const ShownLater& later) {
  Closing closing({X()});
  std::string came;
  for (int k = 0; k < 4 * kPlaces; ++k) {
    Reading r = NumberOf(k);
    r.autocollimator_yaw_rad += later(k);
    try {
      RequireNoJump({X()}, r, closing.taken());
    } catch (const DeviceFault&) {
      return came + "jump";
    }
    closing.Took(r);
    const Reading* const then = closing.Asks();
    if (!then) continue;
    came += fmt::format("{}->{} ", k, then->reading);
    Reading again = NumberOf(then->reading);
    again.autocollimator_yaw_rad += later(k + 0.5);
    try {
      closing.Require(again);
    } catch (const DeviceFault& fault) {
      return came + std::string(FaultName(fault.kind()));
    }
  }
  return came;
}

TEST(Closing, WhatIsShownAtThePlaceWherePassesBeganIsAsItWasOrHasDriftedSteadily) {
  const auto jumps_at = [](double n) { return [n](double k) { return k >= n ? kJump : 0.0; }; };
  const std::string all = "15->0 23->8 31->16 ";
  EXPECT_EQ(Closed([](double) { return 0.0; }), all);
  EXPECT_EQ(Closed([](double k) { return 1e-6 * k; }), all);
  EXPECT_EQ(Closed([](double k) { return k >= 8 ? 1e-6 : 0.0; }), all);  // 10 times the noise
  for (const double n : {1.0, 8.0, 15.0, 15.25}) EXPECT_EQ(Closed(jumps_at(n)), "15->0 implausible") << n;
  for (const double n : {2.0, 5.0, 12.0, 14.0}) EXPECT_EQ(Closed(jumps_at(n)), "jump") << n;
  for (const double n : {16.0, 17.0, 23.0}) EXPECT_EQ(Closed(jumps_at(n)), "15->0 23->8 implausible") << n;
  for (const double n : {24.0, 31.0}) EXPECT_EQ(Closed(jumps_at(n)), all + "implausible") << n;
}

/// Two channels that differ by an offset and the same curve over the places, exchanged from the n-th of all on. How many pass.
int PassUntilExchangeIsNoticed(int n, double curve_V) {
  const ClaimedColumn a = ClaimOf("rotary_4dof", "psd_a_x_V"), b = ClaimOf("rotary_4dof", "psd_b_x_V");
  std::vector<Reading> kept;
  for (int k = 0; k < 2 * kPlaces; ++k) {
    Reading r = NumberOf(k);
    const double apart_V = 1e-2 + curve_V * std::sin(1.0 + r.position) + r.pass * 1e-3;  // a reversal, too
    r.mean_V = {0.1 * r.position + apart_V, 0.0, 0.1 * r.position, 0.0};
    if (k >= n) std::swap(r.mean_V[0], r.mean_V[2]);
    try {
      RequireNotExchanged(a, b, r, kept);
    } catch (const DeviceFault&) {
      return k;
    }
    kept.push_back(r);
  }
  return 2 * kPlaces;
}

TEST(RequireNotExchanged, SpotsDifferAgainstEachOtherAsInThePassBefore) {
  EXPECT_EQ(PassUntilExchangeIsNoticed(100, 1e-4), 16);
  EXPECT_EQ(PassUntilExchangeIsNoticed(0, 1e-4), 16);  // from the begin on nothing tells it
  EXPECT_EQ(PassUntilExchangeIsNoticed(8, 1e-4), 13);
  EXPECT_EQ(PassUntilExchangeIsNoticed(10, 1e-4), 15);
  EXPECT_EQ(PassUntilExchangeIsNoticed(4, 1e-4), 16);  // four places are too few
  EXPECT_EQ(PassUntilExchangeIsNoticed(8, 1e-6), 16);  // less than ten times the noise
}

}  // namespace
}  // namespace twinbench::procedure
