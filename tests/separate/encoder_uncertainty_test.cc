#include <gtest/gtest.h>

#include "tests/separate/encoder_readings.h"
#include "tests/support/night.h"
#include "twin/benches/encoder_comparison/estimators/device_error.h"

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

}  // namespace
}  // namespace twinbench::separate::encoder
