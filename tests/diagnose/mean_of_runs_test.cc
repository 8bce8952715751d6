#include "twin/diagnose/mean_of_runs.h"

#include <gtest/gtest.h>

#include <cmath>

#include "twin/benches/registry.h"
#include "twin/core/stream.h"
#include "twin/core/units.h"

namespace twinbench::diagnose {
namespace {

using Readings = std::vector<Reading>;

/// Twelve stops; the device shows within a turn what the reference does, and `off_rad`.
Readings Stops(double off_rad, double reference_rad = 0.0) {
  Readings readings(12);
  for (int i = 0; i < 12; ++i) {
    Reading& r = readings[static_cast<std::size_t>(i)];
    r.reading = r.position = i;
    r.reference_rad = units::turn / 12.0 * i + reference_rad;
    r.measured_rad = std::fmod(r.reference_rad + off_rad + units::turn, units::turn);
    r.temperature_degC = 20.0 + off_rad;
  }
  return readings;
}

const BenchFormat& Format() {
  return FormatOf("encoder_comparison");
}

TEST(MeanOfRuns, IsThatOfAngleAndCircumstancesAtEveryStop) {
  const Readings a = Stops(1e-3), b = Stops(3e-3, 2e-6);
  const Readings mean = MeanOfRuns({&a, &b}, Format()).value();
  EXPECT_EQ(RunsIn(mean), 2);
  EXPECT_EQ(RunsIn(a), 1);
  for (std::size_t i = 0; i < mean.size(); ++i) {
    EXPECT_NEAR(mean[i].measured_rad - mean[i].reference_rad, 2e-3, 1e-12);
    EXPECT_NEAR(mean[i].temperature_degC, 20.002, 1e-12);
  }
}

TEST(MeanOfRuns, OfAnAngleAcrossTheTurnIsNoHalfTurnOff) {
  const Readings a = Stops(-1e-3), b = Stops(2e-3);  // at the first stop: just below a turn, and just above none
  const Readings mean = MeanOfRuns({&a, &b}, Format()).value();
  EXPECT_NEAR(std::remainder(mean[0].measured_rad, units::turn), 0.5e-3, 1e-12);
}

TEST(MeanOfRuns, LacksWhatOneOfThemLacksAndOfOtherStopsIsNone) {
  const Readings a = Stops(0.0);
  Readings lacking = a, back = a, shorter = a;
  lacking[3].status = ReadingStatus::kMissing;
  EXPECT_EQ(MeanOfRuns({&a, &lacking}, Format()).value()[3].status, ReadingStatus::kMissing);
  EXPECT_EQ(MeanOfRuns({&lacking, &a}, Format()).value()[3].status, ReadingStatus::kMissing);
  back[3].direction = -1;
  shorter.pop_back();
  EXPECT_FALSE(MeanOfRuns({&a, &back}, Format()));
  EXPECT_FALSE(MeanOfRuns({&a, &shorter}, Format()));
}

/// Standard deviation over many places of the mean of `runs` roundings of one angle with noise, by drawing.
double DrawnOfMean(double noise, double step, int runs) {
  Stream stream(3, "test.mean_of_runs");
  constexpr int kPlaces = 40000;
  double squares = 0.0;
  for (int place = 0; place < kPlaces; ++place) {
    const double at = step * stream.Uniform();
    double sum = 0.0;
    for (int run = 0; run < runs; ++run) sum += step * std::round((at + noise * stream.Normal()) / step) - at;
    squares += sum * sum / (runs * runs);
  }
  return std::sqrt(squares / kPlaces);
}

TEST(ScaleToMean, SaysWhatNoiseAndRoundingLeaveInTheMean) {
  const double step = 1e-6;
  constexpr int kRuns = 7;
  for (const double noise : {0.05e-6, 0.3e-6, 2e-6}) {
    const Readings a = Stops(0.0);
    const Readings mean = MeanOfRuns(std::vector<const Readings*>(kRuns, &a), Format()).value();
    LinearRun run;
    run.rounding = step;
    run.sigma = Eigen::VectorXd::Constant(12, std::hypot(noise, step / std::sqrt(12.0)));
    ScaleToMean(mean, run);
    EXPECT_NEAR(run.sigma[0] / DrawnOfMean(noise, step, kRuns), 1.0, 0.05) << noise;
  }
}

}  // namespace
}  // namespace twinbench::diagnose
