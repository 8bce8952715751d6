#include "tests/separate/encoder_readings.h"
#include "tests/separate/shift_formulas.h"
#include "tests/support/kept_text.h"
#include "tests/support/over_seeds.h"
#include "twin/benches/encoder_comparison/estimators/several_heads.h"
#include "twin/benches/encoder_comparison/estimators/time_reversal.h"
#include "twin/core/reading_column.h"

namespace twinbench::separate::encoder {
namespace {

using test::MeanOrderChi2, test::ValueOf, test::Wave, test::WorstOrder_arcsec;
using units::arcsec, units::deg;

/// Heads on one ring, from closed forms: the shaft stands somewhere near each stop, and what the reference shows of it
/// has an error and a noise of its own.
struct Ring {
  std::vector<Wave> ring = {{1, 2.0, 0.4}, {2, 0.7, -1.0}, {5, 0.3, 2.0}, {9, 0.2, 0.1}};
  std::vector<Wave> reference = {{1, 4.0, 1.0}, {3, 1.0, -0.5}};
  std::vector<double> heads_deg = {0.0, 90.0, 180.0, 270.0};
  int stops = 72, turns = 1;
  double noise_arcsec = 0.0, reference_noise_arcsec = 0.0, scatter_deg = 0.0;
  std::uint64_t seed = 1;
  std::function<bool(int, int)> missing = {};  // by stop and head

  std::vector<Reading> Readings() const {
    Stream stream(seed, "test.heads");
    std::vector<Reading> readings;
    for (int i = 0; i < stops * turns; ++i) {
      const double shaft = 0.02 + units::turn * i / stops + scatter_deg * deg * stream.Normal();
      const double shown =
          shaft + ValueOf(reference, shaft) + reference_noise_arcsec * arcsec * stream.Normal();
      for (std::size_t j = 0; j < heads_deg.size(); ++j) {
        Reading r{.reading = static_cast<int>(readings.size()), .time = Time(FromSeconds(i)),
                  .setup = static_cast<int>(j), .position = i, .reference_rad = shown,
                  .head_rad = heads_deg[j] * deg};
        const double at = shaft - r.head_rad;
        r.measured_rad = at + ValueOf(ring, at) + noise_arcsec * arcsec * stream.Normal();
        if (missing && missing(i, static_cast<int>(j))) r.measured_rad = kNaN, r.status = ReadingStatus::kMissing;
        readings.push_back(r);
      }
    }
    return readings;
  }
};

TEST(SeparateHeads, AtEqualDivisionGiveAllOrdersButMultiplesOfTheirCount) {
  Ring bench;
  bench.ring.push_back({4, 3.0, 0.0});  // which all heads share
  const SeveralHeads found = SeparateHeads(bench.Readings());
  EXPECT_EQ(found.Highest(), 35);
  EXPECT_TRUE(std::isnan(found.ring.At(4).value.real()));
  EXPECT_EQ(found.lost.orders, (std::vector{4, 8, 12, 16, 20, 24, 28, 32}));
  // The angle at which the ring is read is off by the errors: 4 arcsec x 9 x 0.2 arcsec is 4e-5 arcsec.
  EXPECT_LT(WorstOrder_arcsec(found.ring, Ring{}.ring), 1e-4);
  EXPECT_LT(WorstOrder_arcsec(found.reference, Ring{}.reference), 2e-4);
}

TEST(SeparateHeads, AtAnyAnglesGiveEveryOrderWithHeadsThatFailAndAShaftThatScatters) {
  Ring bench;
  bench.ring.push_back({4, 0.9, -0.3});
  bench.ring.push_back({28, 0.1, 1.3});
  bench.heads_deg = {0.0, 33.0, 118.0, 201.5};
  bench.scatter_deg = 0.5;
  bench.reference_noise_arcsec = 20.0;
  bench.missing = [](int stop, int head) { return (stop * 5 + head) % 11 == 0; };
  bench.turns = 2;
  const SeveralHeads found = SeparateHeads(bench.Readings());
  EXPECT_TRUE(found.lost.orders.empty());
  EXPECT_GT(found.Highest(), 28);
  EXPECT_GT(found.left_out, 40);
  // The place on the ring is as uncertain as the reference: 20 arcsec x 28 x 0.1 arcsec is 3e-4 arcsec.
  EXPECT_LT(WorstOrder_arcsec(found.ring, bench.ring), 5e-4);
}

TEST(SeparateHeads, StateTheVarianceOfTheClosedForm) {
  Ring bench{.heads_deg = {0.0, 35.0, 110.0}, .turns = 40, .noise_arcsec = 1.0};
  const SeveralHeads found = SeparateHeads(bench.Readings());
  for (const int order : {1, 2, 7, 12, 30}) {
    const double closed = 2.0 * ShiftVariance(360, bench.heads_deg, order) * 360.0 / (72 * 40);  // re and im
    // sigma^2 from 5600 residuals: 2 %; three of these.
    EXPECT_NEAR(found.ring.At(order).cov(0, 0) / (arcsec * arcsec) / closed, 1.0, 0.06) << order;
  }
}

TEST(SeparateHeads, CoverRingAndReferenceOverSeeds) {
  const Eigen::Array3d chi2 = twinbench::test::MeanOverSeeds(30, [](std::uint64_t seed) {
    const Ring bench{.turns = 2, .noise_arcsec = 0.05, .reference_noise_arcsec = 0.3, .seed = seed};
    const auto readings = bench.Readings();
    const SeveralHeads found = SeparateHeads(readings);
    return Eigen::Array3d(MeanOrderChi2(found.ring, bench.ring), MeanOrderChi2(found.reference, bench.reference),
                          MeanOrderChi2(EqualDivision(readings).ring, bench.ring));
  });
  // 27 orders x 30 seeds, 2 parts each: 0.035; the variances are from 73 to 375 degrees of freedom each time.
  EXPECT_NEAR(chi2[0], 1.0, 0.1) << "ring";
  EXPECT_NEAR(chi2[1], 73.0 / 71.0, 0.1) << "reference";
  EXPECT_NEAR(chi2[2], 89.0 / 87.0, 0.1) << "published";
}

TEST(EqualDivision, IsNoisierThanAllHeadsByTheRootOfTheOthers) {
  Ring bench{.turns = 20, .noise_arcsec = 0.1};
  const auto readings = bench.Readings();
  const SeveralHeads rigorous = SeparateHeads(readings), published = EqualDivision(readings);
  // One head less the mean of N has (N - 1) / N of its variance, all together 1 / N of it.
  EXPECT_NEAR(published.ring.At(3).cov(0, 0) / rigorous.ring.At(3).cov(0, 0), 3.0, 0.25);
  EXPECT_NEAR(published.residual_rms_rad / arcsec, 0.1, 0.006) << "of one head";
  EXPECT_EQ(published.lost.orders, rigorous.lost.orders);
  EXPECT_TRUE(published.notes.empty());
}

TEST(EqualDivision, ErrsWithHeadsElsewhereAndSaysSo) {
  Ring bench{.heads_deg = {0.0, 80.0, 185.0, 270.0}, .noise_arcsec = 0.01};
  const auto readings = bench.Readings();
  const SeveralHeads published = EqualDivision(readings);
  EXPECT_GT(WorstOrder_arcsec(published.ring, bench.ring), 0.05) << "2 arcsec x the mean of exp(j head), 0.06";
  EXPECT_LT(WorstOrder_arcsec(SeparateHeads(readings).ring, bench.ring), 0.01);
  ASSERT_EQ(published.notes.size(), 1u);
  EXPECT_NE(published.notes.front().find("BIASED"), std::string::npos);
  const double error = std::abs(published.ring.At(1).value - std::polar(2.0 * arcsec, 0.4));
  EXPECT_LT(error, 2.5 * harmonics::LargestUncertainty(published.ring.At(1)));
}

TEST(LostOrders, AreAssumedToFallAsOneOverTheOrder) {
  Ring bench;
  bench.ring.clear();
  for (int k = 1; k <= 35; ++k) bench.ring.push_back({k, 1.0 / k, 0.7 * k * k});
  bench.turns = 2;
  bench.noise_arcsec = 1e-4;
  double lost = 0.0;
  for (int k = 4; k <= 32; k += 4) lost += 0.5 / (k * k);
  EXPECT_NEAR(SeparateHeads(bench.Readings()).lost.assumed_rad / arcsec, std::sqrt(lost), 0.01 * std::sqrt(lost));
}

TEST(SeparateHeads, SayWhyThereIsNoCurve) {
  std::vector<Reading> readings = Ring{}.Readings();
  for (Reading& r : readings) r.time = Time(FromSeconds(r.reading));
  EXPECT_KEPT(SeparateHeads(readings).not_separated);
  Ring part{.stops = 360};
  readings = part.Readings();
  readings.resize(300);
  EXPECT_KEPT(SeparateHeads(readings).not_separated);
  Ring alike{.heads_deg = {0.0, 360.0}};
  EXPECT_KEPT(SeparateHeads(alike.Readings()).not_separated);
}

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
          Reading r{.reading = static_cast<int>(readings.size()), .pass = pass, .direction = sense};
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
  EXPECT_THAT(found.not_separable, testing::ElementsAre(testing::HasSubstr("orders above 63")));  // of 128 lines
}

TEST(SeparateByTime, CountsForTheRingWhatOneSpeedDoesNotTell) {
  Coast bench{.speeds_rad_s = {30.0}};
  const TimeReversal found = SeparateByTime(bench.Readings());
  EXPECT_EQ(found.not_separable.size(), 2u);  // the torque, and orders above those of 128 lines
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
  const Eigen::Array3d mean = twinbench::test::MeanOverSeeds(15, [](std::uint64_t seed) {
    const Coast bench{.tau_s = 2000.0, .noise_s = 5e-9, .seed = seed};
    const auto readings = bench.Readings();
    const TimeReversal found = SeparateByTime(readings);
    return Eigen::Array3d(MeanOrderChi2(found.ring, bench.ring), found.stamp_noise_s / 1e-9,
                          MeanOrderChi2(DynamicReversal(readings).ring, bench.ring));
  });
  // 63 orders x 15 seeds, 2 parts each: 0.033; four of these.
  EXPECT_NEAR(mean[0], 1.0, 0.13);
  EXPECT_NEAR(mean[1], 5.0, 0.1);
  // Turns share the times that close them, and the distance to the rigorous result is part of the uncertainty.
  EXPECT_NEAR(mean[2], 1.0, 0.4) << "published";
}

TEST(SeparateByTime, SaysWhyThereIsNoCurve) {
  Coast bench{.turns = 3};
  EXPECT_KEPT(SeparateByTime(bench.Readings()).not_separated);
  EXPECT_KEPT(DynamicReversal({}).not_separated);
}

}  // namespace
}  // namespace twinbench::separate::encoder
