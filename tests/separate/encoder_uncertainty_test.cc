#include <gtest/gtest.h>

#include "tests/separate/encoder_readings.h"
#include "tests/support/night.h"
#include "twin/benches/encoder_comparison/estimators/device_error.h"
#include "twin/benches/encoder_comparison/estimators/iso230_2.h"
#include "twin/core/rounding.h"

namespace twinbench::separate::encoder {
namespace {

using test::Comparison, test::ValueOf;
using units::deg;

const int kSeeds = test::ByNight(200, 60);

/// Means of (error / u)^2 over seeds, and over positions or orders of the curves.
struct Coverage {
  double device = 0.0, reference = 0.0, first_order = 0.0, reversal = 0.0;
};

double MeanChi2(const harmonics::HarmonicSeries& series, const std::vector<test::Wave>& waves) {
  const CurveAt curve = Curve(series, 72);
  double sum = 0.0;
  for (int i = 0; i < 72; ++i)
    sum += std::pow((curve.value_rad[i] - ValueOf(waves, 5.0 * i * deg)) / curve.u_rad[i], 2) / 72.0;
  return sum;
}

Coverage CoverageOf(Comparison bench) {
  Coverage mean;
  for (int seed = 0; seed < kSeeds; ++seed) {
    bench.seed = static_cast<std::uint64_t>(seed);
    const DeviceError e = SeparateDevice(bench.Readings());
    mean.device += MeanChi2(e.curves.device, bench.device) / kSeeds;
    mean.first_order += test::OrderChi2(e.curves.device, bench.device, 1) / kSeeds;
    mean.reversal += std::pow(e.reversal.value_rad / e.reversal.u_rad, 2) / kSeeds;
    if (!e.curves.reference.orders.empty())
      mean.reference += MeanChi2(e.curves.reference, bench.reference) / kSeeds;
  }
  return mean;
}

// Small errors, so that error x slope does not count: 5 arcsec x 5e-5.
const std::vector<test::Wave> kSmallDevice = {{1, 5.0, 0.4}, {5, 3.0, 1.0}}, kSmallReference = {{1, 4.0, -1.0}};

// Of 35 orders' chi-squared over 60 seeds the mean has a standard deviation of 0.03, one order's (2 parts) 0.13.
// The uncertainty is from 12 degrees of freedom for order 1 with one mounting: 1 / F has the mean 12 / 10 there.

TEST(SeparateDeviceUncertainty, CoversWhiteNoiseWithOneMounting) {
  const Coverage c = CoverageOf({.device = kSmallDevice, .noise_arcsec = 7.0});
  EXPECT_NEAR(c.device, 1.0, 0.15);
  EXPECT_NEAR(c.first_order, 1.2, 0.35);
  // Pooled from two degrees of freedom, but never below the readings' noise.
  EXPECT_NEAR(c.reversal, 0.8, 0.4);
}

TEST(SeparateDeviceUncertainty, CoversDeviceAndReferenceWithThreeMountings) {
  const std::vector<double> mounting_rad = {0.0, 100.0 * deg, 215.0 * deg};
  const Coverage c = CoverageOf(
      {.device = kSmallDevice, .reference = kSmallReference, .mounting_rad = mounting_rad, .noise_arcsec = 7.0});
  EXPECT_NEAR(c.device, 1.0, 0.15);
  EXPECT_NEAR(c.reference, 1.0, 0.15);
}

TEST(SeparateDeviceUncertainty, CoversASingleTurnByTheResidualsOfItsFit) {
  const Coverage c = CoverageOf({.device = kSmallDevice, .passes = {1, -1}, .turns = 1.0, .noise_arcsec = 7.0});
  EXPECT_NEAR(c.device, 1.0, 0.15);
}

TEST(SeparateDeviceUncertainty, CoversAZeroThatWandersFromReadingToReading) {
  // A random walk of 1 arcsec a reading beside white noise: 12 arcsec in two turns, mostly in the low orders.
  Comparison bench{.device = kSmallDevice, .noise_arcsec = 1.0};
  Stream stream(5, "test.walk");
  std::vector<double> walk;
  bench.drift_arcsec = [&](int i, int) {
    if (i == 0) walk.clear();
    walk.push_back((walk.empty() ? 0.0 : walk.back()) + stream.Normal());
    return walk.back();
  };
  const Coverage c = CoverageOf(bench);
  EXPECT_GT(c.device, 0.5);
  EXPECT_LT(c.device, 2.0);
  EXPECT_LT(c.first_order, 3.0) << "white noise alone would claim 30 times too little variance";
}

struct Steps {
  int bits, stops;
  double noise_arcsec;
  std::vector<double> mounting_deg;
};

std::vector<Reading> Rounded(std::vector<Reading> readings, double step_rad) {
  for (Reading& r : readings) r.measured_rad = step_rad * std::round(r.measured_rad / step_rad);
  return readings;
}

// What steps round alike at every visit of a place is in no scatter. It is known no better than within half a step, and
// by how the beat of stops and steps falls into few orders: (error / u)^2 of 1 within a factor of some.
TEST(SeparateDeviceUncertainty, HasAFloorByStepsThatRoundEveryPassAlike) {
  const std::vector<Steps> cases = {{12, 72, 0.3, {0.0}},  {13, 48, 0.3, {0.0}},         {14, 72, 20.0, {0.0}}, {16, 90, 0.3, {0.0}},
                                    {17, 36, 4.0, {0.0}},  {18, 72, 1.0, {0.0}},         {20, 60, 0.1, {0.0}},  {20, 72, 3.0, {0.0}},
                                    {14, 72, 0.3, {0, 100, 215}}, {16, 72, 0.3, {0, 33.3, 171.7}}};
  const int seeds = test::ByNight(30, 4);
  for (const Steps& c : cases) {
    SCOPED_TRACE(testing::Message() << c.bits << " bit, " << c.stops << " stops, " << c.noise_arcsec << " arcsec");
    const double step_rad = units::turn / std::pow(2.0, c.bits);
    double device = 0.0, largest = 0.0;
    Stream stream(7, "test.mounting");
    for (int seed = 0; seed < seeds; ++seed) {
      Comparison bench{.device = kSmallDevice, .stops = c.stops, .noise_arcsec = c.noise_arcsec, .seed = static_cast<std::uint64_t>(seed)};
      const double start_rad = units::turn * stream.Uniform();
      bench.mounting_rad.clear();
      for (const double at : c.mounting_deg) bench.mounting_rad.push_back(start_rad + at * deg);
      const DeviceError e = SeparateDevice(Rounded(bench.Readings(), step_rad), {.steps = {step_rad}});
      device += MeanChi2(e.curves.device, bench.device) / seeds;
      for (int k = 1; k <= e.curves.device.Highest(); ++k)
        largest = std::max(largest, test::OrderChi2(e.curves.device, bench.device, k));
    }
    EXPECT_GT(device, 0.2);
    EXPECT_LT(device, 4.0);
    EXPECT_LT(largest, 15.0) << "of thousands of orders";
    const DeviceError found = SeparateDevice(Rounded(Comparison{.device = kSmallDevice, .stops = c.stops}.Readings(), step_rad));
    EXPECT_GT(found.curves.device.At(1).cov.trace(), 1e-4 * step_rad * step_rad) << "the readings show their steps";
  }
}

TEST(Positioning, KnowsItsTargetsNoBetterThanInSteps) {
  Stream stream(11, "test.noise");
  for (const double noise : {0.02, 0.3, 1.0}) {  // of a step
    double mean = 0.0, reversal = 0.0;
    std::vector<measure::PositioningTarget> targets;
    for (int i = 0; i < 300; ++i) {
      measure::PositioningTarget target{i * 0.02, {}, {}};
      const double place = 10.0 * stream.Uniform();  // true deviation: less itself
      const auto shown = [&](double back) { return std::round(place + back + noise * stream.Normal()) - place; };
      for (int run = 0; run < 5; ++run) target.forward.push_back(shown(0.0)), target.backward.push_back(shown(0.37) - 0.37);
      targets.push_back(target);
    }
    const auto all = measure::EvaluatePositioning(targets, {.replicas = 0}, measure::RoundingOfTargets(targets, 1.0, 1.0));
    for (const auto& t : all.targets) {
      mean += std::pow(t.mean / t.u_mean, 2) / 300.0;
      reversal += std::pow(t.reversal / t.u_reversal, 2) / 300.0;
    }
    EXPECT_GT(std::min(mean, reversal), 0.3) << noise;
    EXPECT_LT(std::max(mean, reversal), 2.5) << noise;
  }
}

TEST(NoiseBehindRounding, IsWhatMakesRoundedReadingsScatterAsTheyDo) {
  for (const double noise : {0.1, 0.2, 0.35, 1.0}) {
    Stream stream(3, "test.noise");
    double squares = 0.0, repeated = 0.0;
    constexpr int kPlaces = 400, kVisits = 50;
    for (int place = 0; place < kPlaces; ++place) {
      const double at = stream.Uniform();
      double sum = 0.0, sum2 = 0.0;
      for (int k = 0; k < kVisits; ++k) {
        const double error = std::round(at + noise * stream.Normal()) - at;
        sum += error;
        sum2 += error * error;
      }
      squares += (sum2 - sum * sum / kVisits) / (kVisits - 1);
      repeated += std::pow(sum / kVisits, 2) / kPlaces;
    }
    const double scatter2 = squares / kPlaces;
    // Of 20 000 readings 1 %; the mean of 50 has a fiftieth of their scatter besides what repeats.
    EXPECT_NEAR(NoiseBehindRounding(1.0, std::sqrt(scatter2)), noise, 0.03 * std::max(noise, 0.3)) << noise;
    EXPECT_NEAR(RoundingOf(1.0, noise, kVisits).repeated, repeated - scatter2 / kVisits, 0.006) << noise;
    const Eigen::MatrixXd waves = RoundingWaves(Eigen::Vector2d(0.3, 5.3), 1.0, noise);
    EXPECT_NEAR(waves.row(0).dot(waves.row(1)), RepeatedByRounding(noise), 1e-12) << "whole steps apart";
  }
  EXPECT_EQ(NoiseBehindRounding(1.0, 0.0), 0.0);
}

}  // namespace
}  // namespace twinbench::separate::encoder
