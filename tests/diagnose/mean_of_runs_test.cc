#include "twin/core/stream.h"
#include "twin/core/units.h"
#include "twin/diagnose/grouping.h"
#include "twin/diagnose/mean_of_runs.h"
#include "twin/diagnose/single_outliers.h"

namespace twinbench::diagnose {
namespace {

using units::deg;

/// Two passes of so many readings, there and back.
Schedule ThereAndBack(int readings) {
  Schedule s;
  for (int i = 0; i < 2 * readings; ++i) {
    s.reading.push_back(100 + i);
    s.setup.push_back(0);
    s.pass.push_back(i / readings);
    s.direction.push_back(i < readings ? 1 : -1);
    s.position.push_back(i % readings);
    s.phase.push_back(Phase{});
  }
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(2 * readings);
  s.dwell_s = s.temperature_degC = s.reference_rad = s.velocity_rad_s = none;
  s.time_s = Eigen::VectorXd::LinSpaced(2 * readings, 0.0, 2.0 * readings - 1.0);
  s.target_rad = deg * s.time_s;
  return s;
}

TEST(Grouping, KeepsPassesApartAndLeavesTheirLastGroupSmaller) {
  const Grouping groups = GroupsOf(ThereAndBack(7), 3);
  EXPECT_EQ(groups.start, (std::vector<int>{0, 3, 6, 7, 10, 13, 14}));
  const Schedule rows = Grouped(ThereAndBack(7), groups);
  EXPECT_EQ(rows.reading, (std::vector<int>{100, 103, 106, 107, 110, 113}));
  EXPECT_EQ(rows.time_s[1], 4.0);
}

TEST(Grouping, TakesTheMeanOfEveryChannelByItself) {
  const Grouping groups = GroupsOf(ThereAndBack(2), 2);
  Eigen::VectorXd rows(8);  // of two channels
  rows << 1.0, 10.0, 3.0, 30.0, 5.0, 50.0, 9.0, 90.0;
  EXPECT_EQ(groups.MeanOfRows(rows).col(0), (Eigen::Vector4d(2.0, 20.0, 7.0, 70.0)));
}

TEST(Grouping, IsAsLargeAsLeavesTheLineFourFifths) {
  const Schedule s = ThereAndBack(360);
  // x = 15 deg: 0.911 of three, 0.837 of four, 0.746 of five.
  EXPECT_EQ(LargestGroups(s, 30.0 * s.target_rad, {}).Size(0), 4);
  // A wave that is folded to half a turn from one reading to the next does not survive a mean of two or four; of
  // three a third is left: they stay alone.
  EXPECT_EQ(LargestGroups(s, 30.0 * s.target_rad, 180.0 * s.target_rad).Size(0), 1);
}

TEST(SingleOutliers, AreFarFromBothSidesAndNoStep) {
  const Schedule s = ThereAndBack(500);
  Stream stream(5, "test.single_outliers");
  Eigen::VectorXd left(s.Readings());
  for (double& value : left) value = stream.Normal();
  left.tail(300).array() += 50.0;  // a step, at reading 800
  for (const int i : {120, 640}) left[i] += 20.0;
  const SingleOutliers found = FindSingleOutliers(s, "a", left);
  EXPECT_EQ(found.readings, (std::vector<int>{220, 740}));
  EXPECT_NEAR(found.size, 20.0, 2.0);  // the noise of two, and of the medians beside them
  EXPECT_EQ(found.of, 1000);
}

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
