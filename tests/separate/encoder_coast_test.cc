#include <gtest/gtest.h>

#include "tests/separate/encoder_readings.h"
#include "tests/support/kept_text.h"
#include "twin/benches/encoder_comparison/estimators/time_reversal.h"
#include "twin/core/reading_column.h"

namespace twinbench::separate::encoder {
namespace {

using test::MeanOrderChi2, test::ValueOf, test::Wave, test::WorstOrder_arcsec;
using units::arcsec;

/// A coasting spindle from closed forms: exponential loss of speed, moved beside it by waves of its angle.
struct Coast {
  std::vector<Wave> ring = {{1, 2.0, 0.4}, {3, 0.5, -1.0}, {12, 0.3, 2.0}, {30, 0.1, 0.1}};
  std::vector<Wave> torque = {{12, 0.2, 1.0}};   // as it moves the shaft at the first speed
  std::vector<Wave> friction = {{3, 0.4, -0.5}};  // likewise, forwards
  std::vector<double> speeds_rad_s = {30.0, 15.0};
  std::vector<int> senses = {1, -1};
  int lines = 128, turns = 8;
  double tau_s = 500.0, noise_s = 0.0;
  std::uint64_t seed = 1;
  std::function<bool(int)> missing = {};  // by running number

  std::vector<Reading> Readings() const {
    Stream stream(seed, "test.stamps");
    std::vector<Reading> readings;
    int pass = 0;
    double begin_s = 0.0;
    for (const double speed : speeds_rad_s) {
      for (const int sense : senses) {
        for (int i = 0; i <= lines * turns; ++i) {
          Reading r;
          r.reading = static_cast<int>(readings.size());
          r.pass = pass;
          r.direction = sense;
          r.reference_rad = r.measured_rad = 0.1 + sense * units::turn * i / lines;
          const double stamp_s = begin_s + Time_s(r.reference_rad, speed, sense) + noise_s * stream.Normal();
          r.time = Time(FromSeconds(stamp_s));
          Quantity{"stamp_s"}(r) = stamp_s;
          if (missing && missing(r.reading)) r.status = ReadingStatus::kMissing;
          readings.push_back(r);
        }
        begin_s += turns * units::turn / speed + 10.0;
        ++pass;
      }
    }
    return readings;
  }

 private:
  /// Smooth way s speed tau (1 - exp(-t / tau)) = shaft less what moves it beside that.
  double Time_s(double line_rad, double speed, int sense) const {
    const double shaft = line_rad - ValueOf(ring, line_rad);
    const double now = speed - (sense * (shaft - 0.1)) / tau_s;
    const double slowness = std::pow(speeds_rad_s.front() / now, 2);
    const double smooth =
        shaft - slowness * (ValueOf(torque, line_rad) + sense * ValueOf(friction, line_rad)) - 0.1;
    return -tau_s * std::log1p(-sense * smooth / (speed * tau_s));
  }
};

TEST(SeparateByTime, TellsTheRingFromTorqueAndFriction) {
  const TimeReversal found = SeparateByTime(Coast{}.Readings());
  EXPECT_EQ(found.ring.Highest(), 63);
  EXPECT_EQ(found.turns, 4 * 8);
  // Changes of the speed within a turn move waves by a share of (2 pi / speed) / tau: 1e-3 of them at the slow speed.
  EXPECT_LT(WorstOrder_arcsec(found.ring, Coast{}.ring), 1e-3);
  // Theirs is the highest speed of a turn, below that of the start by half a turn's loss: 4e-4.
  EXPECT_LT(WorstOrder_arcsec(found.torque, Coast{}.torque), 1e-3);
  EXPECT_LT(WorstOrder_arcsec(found.friction, Coast{}.friction), 1e-3);
  EXPECT_TRUE(found.not_separable.empty());
}

TEST(SeparateByTime, CountsForTheRingWhatOneSpeedDoesNotTell) {
  Coast bench;
  bench.speeds_rad_s = {30.0};
  const TimeReversal found = SeparateByTime(bench.Readings());
  ASSERT_EQ(found.not_separable.size(), 1u);
  EXPECT_TRUE(found.torque.orders.empty());
  const auto sum = std::polar(0.3, 2.0) + std::polar(0.2, 1.0);
  EXPECT_NEAR(std::abs(found.ring.At(12).value / arcsec - sum), 0.0, 5e-3) << "a per cent of the torque";
  EXPECT_NEAR(std::abs(found.ring.At(3).value / arcsec - std::polar(0.5, -1.0)), 0.0, 5e-3) << "both senses";
}

TEST(SeparateByTime, LeavesOutTurnsWithAMissingLine) {
  Coast bench;
  bench.missing = [](int reading) { return reading % 1500 == 700; };
  const TimeReversal found = SeparateByTime(bench.Readings());
  EXPECT_EQ(found.left_out, 3);
  EXPECT_LT(found.turns, 32);
  EXPECT_LT(WorstOrder_arcsec(found.ring, bench.ring), 1e-3);
}

TEST(SeparateByTime, CoversTheRingOverSeedsAndTellsTheNoiseOfATime) {
  constexpr int kSeeds = 15;
  double rigorous = 0.0, published = 0.0, noise_ns = 0.0;
  for (int seed = 0; seed < kSeeds; ++seed) {
    Coast bench;
    bench.noise_s = 5e-9;
    bench.tau_s = 2000.0;
    bench.seed = static_cast<std::uint64_t>(seed);
    const auto readings = bench.Readings();
    const TimeReversal found = SeparateByTime(readings);
    rigorous += MeanOrderChi2(found.ring, bench.ring) / kSeeds;
    noise_ns += found.stamp_noise_s / 1e-9 / kSeeds;
    published += MeanOrderChi2(DynamicReversal(readings).ring, bench.ring) / kSeeds;
  }
  // 63 orders x 15 seeds, 2 parts each: 0.033; four of these.
  EXPECT_NEAR(rigorous, 1.0, 0.13);
  EXPECT_NEAR(noise_ns, 5.0, 0.1);
  // Turns share the times that close them, and the distance to the rigorous result is part of the uncertainty.
  EXPECT_NEAR(published, 1.0, 0.4);
}

TEST(SeparateByTime, SaysWhyThereIsNoCurve) {
  Coast bench;
  bench.turns = 3;
  EXPECT_KEPT(SeparateByTime(bench.Readings()).not_separated);
  EXPECT_KEPT(DynamicReversal({}).not_separated);
}

}  // namespace
}  // namespace twinbench::separate::encoder
