#include "twin/diagnose/gain.h"

#include "tests/diagnose/ring_run.h"
#include "tests/support/over_seeds.h"
#include "tests/support/twin_run.h"
#include "twin/benches/rotary_4dof/bench.h"
#include "twin/benches/rotary_4dof/settings.h"
#include "twin/core/linear_algebra.h"
#include "twin/diagnose/accepted_columns.h"
#include "twin/diagnose/folds.h"
#include "twin/diagnose/held_out.h"

namespace twinbench::diagnose {
namespace {

using namespace test;
using twinbench::test::CountOverSeeds, twinbench::test::MeanOverSeeds;

/// With unknowns, noise, and what `cause` shows in a size.
LinearRun RingWith(std::uint64_t seed, double size, Accepted (*cause)(const LinearRun&),
                   const RingShape& shape = {}) {
  LinearRun run = MakeRing(shape);
  AddUnknowns(run, seed);
  AddRingNoise(run, seed);
  run.residual += size * cause(run).columns.col(0);
  return run;
}

/// Of causes that the written file shows as they were fitted.
Gain GainOf(const LinearRun& run, std::vector<Accepted> accepted) {
  for (Accepted& a : accepted) {
    const NoiseModel noise = WhiteNoise(run);
    a.amplitudes =
        FitAmplitudes(ProjectorOf(run, noise), noise.Whiten(run, a.columns),
                      noise.Whiten(run, Eigen::MatrixXd(run.residual)), ColumnsOf({a}, run.Rows()).prior_precision);
  }
  return MeasureGain(run, WhiteNoise(run), accepted, ShownByFit(run, accepted));
}

TEST(Folds, LeaveOutOnePassOfEverySetUpAndBlocksOfTheCalibration) {
  const LinearRun run = MakeRing();
  const Folds folds = MakeFolds(run.schedule);
  EXPECT_EQ(folds.count, 4);
  for (int i = 0; i < run.schedule.Readings(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    const bool calibration = run.schedule.phase[k] == Phase::kCalibration;
    EXPECT_EQ(folds.of_reading[k], calibration ? i / 6 : run.schedule.pass[k]);
  }
}

TEST(Folds, OfASinglePassAreBlocksOfTime) {
  const LinearRun run = MakeRing({24, {0}, {1}, 0});
  const Folds folds = MakeFolds(run.schedule);
  EXPECT_EQ(std::set<int>(folds.of_reading.begin(), folds.of_reading.end()), (std::set<int>{0, 1, 2, 3}));
  EXPECT_EQ(folds.of_reading[0], folds.of_reading[5]);
  EXPECT_NE(folds.of_reading[5], folds.of_reading[6]);
}

TEST(Folds, OfManyPassesLeaveOutSeveralAtATime) {
  const std::vector<int> passes(47, 1);
  const Folds folds = MakeFolds(MakeRing({4, {0}, passes, 0}).schedule);
  EXPECT_EQ(folds.count, 20);
  EXPECT_EQ(folds.of_reading.front(), folds.of_reading[20 * 4]);
}

TEST(MeasureGain, WithoutCausesIsNothing) {
  const LinearRun run = RingWith(1, 0.0, Direction);
  const Gain gain = GainOf(run, {});
  EXPECT_EQ(gain.folds, 0);
  EXPECT_FALSE(gain.positive);
}

/// Held-out prediction of a reading, by dense least squares on the other passes; no blocks, no tricks.
double DenseHeldOutSquares(const LinearRun& run, int pass) {
  std::vector<int> train, held;
  for (int k = 0; k < run.Rows(); ++k) {
    const auto i = static_cast<std::size_t>(run.ReadingOf(k));
    const bool out = run.schedule.phase[i] == Phase::kFullCircle && run.schedule.pass[i] == pass;
    (out ? held : train).push_back(k);
  }
  const Eigen::MatrixXd J = run.nuisance.jacobian;
  const Eigen::MatrixXd J_train = J(train, Eigen::all);
  const Eigen::VectorXd x = SolveShortest(J_train, Eigen::VectorXd(run.residual(train)));
  return (run.residual(held) - J(held, Eigen::all) * x).squaredNorm();
}

TEST(MeasureGain, BeforeIsTheErrorOfADenseFitToTheOtherPasses) {
  const LinearRun run = RingWith(3, 1e-6, Direction, {12, {0, 1, 5}, {1, -1, -1, 1}, 0});
  double mean = 0.0;
  for (int pass = 0; pass < 4; ++pass) mean += DenseHeldOutSquares(run, pass) / run.Rows();
  // The weak prior and the traces of held-out rows count 1e-8.
  EXPECT_NEAR(GainOf(run, {Direction(run)}).before_m, std::sqrt(mean), 1e-6 * std::sqrt(mean));
}

constexpr int kGainRuns = 40;

/// Mean over runs of what is removed by a cause, which is positive in each.
double MeanFraction(const std::function<LinearRun(std::uint64_t seed)>& make, Accepted (*cause)(const LinearRun&)) {
  return MeanOverSeeds(kGainRuns, [&](std::uint64_t seed) {
    const LinearRun run = make(seed);
    const Gain gain = GainOf(run, {cause(run)});
    EXPECT_TRUE(gain.positive) << seed;
    return gain.fraction_removed;
  });
}

/// Variance that is left of the direction, in that of the noise.
double LeftOfNoise(bool is_stated) {
  const Eigen::Array2d power = MeanOverSeeds(kGainRuns, [&](std::uint64_t seed) {
    LinearRun run = RingWith(seed, 1e-6, Direction);
    run.sigma_stated = is_stated;
    const Gain gain = GainOf(run, {Direction(run)});
    EXPECT_EQ(gain.folds, 4);
    return Eigen::Array2d(std::pow(gain.after_m, 2), std::pow(gain.noise_floor_m, 2));
  });
  return power[0] / power[1];
}

TEST(MeasureGain, OfTheTrueCauseLeavesTheNoiseAlsoOneThatNobodyStates) {
  // 288 rows a run, 40 runs: the mean square of the noise scatters by sqrt(2 / 11520) = 1.3 %; the amplitude's own
  // uncertainty adds 1 / 108 on half of the rows.
  EXPECT_NEAR(LeftOfNoise(true), 1.0, 0.05);
  // What neighbouring readings differ by, less what their predictions scatter by.
  EXPECT_NEAR(LeftOfNoise(false), 1.0, 0.05);
}

/// A step of channel b at the last pass of the last set-up.
Accepted LastStep(const LinearRun& run) {
  Eigen::VectorXd step = Eigen::VectorXd::Zero(run.Rows());
  for (int i = run.schedule.Readings() - 12; i < run.schedule.Readings(); ++i) step[kRingChannels * i + 1] = 1.0;
  return TermOf("step", step, 0.0);
}

TEST(MeasureGain, OfTheTrueCauseIsTheWholeRemovableVarianceOfHalfOfItHalfAndOfOnePassMeasuredOnBlocksOfIt) {
  // A direction of 1 um on one of two channels, of which held-out passes see 4/3: removable 8 times the floor.
  EXPECT_NEAR(MeanFraction([](auto seed) { return RingWith(seed, 1e-6, Direction); }, Direction), 1.0, 0.02);
  // Two signatures of equal strength, of which one is accepted.
  const auto on_both = [](auto seed) {
    LinearRun run = RingWith(seed, 1e-6, Direction);
    const Eigen::VectorXd other = Direction(run).columns.col(0);
    for (int k = 0; k + 1 < run.Rows(); k += 2) run.residual[k + 1] += 1e-6 * other[k];
    return run;
  };
  EXPECT_NEAR(MeanFraction(on_both, Direction), 0.5, 0.02);
  // 12 rows with 6.7 deviations, of which the offset and the tables take a part: some 400 to be removed, and the
  // amplitude's own uncertainty leaves about 4/3 of one.
  EXPECT_NEAR(MeanFraction([](auto seed) { return RingWith(seed, 2e-6, LastStep); }, LastStep), 1.0, 0.03);
}

TEST(MeasureGain, OfACauseInADirectionThatWasDrivenOnceIsMeasuredAsWell) {
  LinearRun run = MakeRing({12, {0, 1, 5}, {1, -1}, 0});
  AddRingNoise(run, 7);
  run.residual += 1e-6 * Direction(run).columns.col(0);
  const Gain gain = GainOf(run, {Direction(run)});
  EXPECT_TRUE(gain.positive);
  EXPECT_GT(gain.fraction_removed, 0.8);  // 36 pairs of readings, some 200 to be removed, u = sqrt(144) / 200
}

/// A scale error of channel b in a sweep of +-300 um; the full circles do not see it at all.
Accepted ScaleInSweep(const LinearRun& run) {
  Eigen::VectorXd scale = Eigen::VectorXd::Zero(run.Rows());
  for (int i = 0; i < 26; ++i) scale[kRingChannels * i + 1] = 50e-6 * (i % 13 - 6);
  return TermOf("scale", scale, 0.0, Kind::kNamed, {"gain_error", "1", 1.0, 0.01, -1.0, 1.0});
}

TEST(MeasureGain, CountsACauseThatOnlyTheCalibrationShows) {
  const int positive = CountOverSeeds(20, [](std::uint64_t seed) {
    const LinearRun run =
        RingWith(seed, 0.003, ScaleInSweep, {12, {0, 1, 5}, {1, -1, -1, 1}, 26});  // 0.9 um at the ends
    return GainOf(run, {ScaleInSweep(run)}).positive;
  });
  EXPECT_GE(positive, 19);
}

TEST(MeasureGain, OfACauseThatIsNotThereIsHardlyEverPositive) {
  constexpr int kNothing = 400;
  int positive = 0, above_zero = 0;
  for (std::uint64_t seed = 0; seed < kNothing; ++seed) {
    const LinearRun run = RingWith(1000 + seed, 0.0, Direction);
    const Gain gain = GainOf(run, {Direction(run)});
    positive += gain.positive ? 1 : 0;
    above_zero += gain.interval95[0] > 0.0 ? 1 : 0;
  }
  EXPECT_LE(positive, kNothing / 20);
  EXPECT_LE(above_zero, kNothing / 20);
}

TEST(MeasureGain, SaysThatTheFloorIsTheNoiseAndThePrediction) {
  // Two passes and one set-up: a held-out reading is the other reading's value, so its error has twice the
  // variance.
  LinearRun run = RingWith(5, 0.0, Direction, {12, {0}, {1, -1}, 0});
  const Gain gain = GainOf(run, {Direction(run)});
  EXPECT_NEAR(gain.noise_floor_m, std::sqrt(2.0) * kRingSigma_m, 1e-6 * kRingSigma_m);
}

TEST(ChangeOfTables, IsTheMoveOfEachSeries) {
  // A cause that looks like 2 um on the target's dy and 1 arcsec on the reference's ez and is fitted away again.
  constexpr int kPositions = 3;
  LinearRun run;
  run.channels = {"c"};
  const int unknowns = 9 * kPositions;  // of the target position by position, then of the reference point by point
  // Each unknown is read twice, once with the cause on it.
  run.schedule.reading.resize(static_cast<std::size_t>(2 * unknowns));
  run.nuisance.jacobian.resize(2 * unknowns, unknowns);
  Accepted cause;
  cause.family.amplitudes = {{"size", "1", 1.0, 1e6, -1e9, 1e9}};
  cause.columns = Eigen::MatrixXd::Zero(2 * unknowns, 1);
  for (int k = 0; k < unknowns; ++k) {
    for (const int row : {k, unknowns + k}) run.nuisance.jacobian.insert(row, k) = 1.0;
  }
  run.nuisance.blocks = kPositions;
  run.nuisance.block_size = 4;
  for (int i = 0; i < kPositions; ++i) {
    constexpr int kTargetDy = 3, kReferenceEz = 2;
    cause.columns(unknowns + 4 * i + kTargetDy, 0) = 2.0 * 2e-6;
    cause.columns(unknowns + (4 + kReferenceEz) * kPositions + i, 0) = 2.0 * units::arcsec;
  }
  run.nuisance.prior_precision = Eigen::VectorXd::Constant(unknowns, 1e-12);
  run.residual = cause.columns.col(0);
  run.sigma = Eigen::VectorXd::Constant(2 * unknowns, 1e-9);
  DiagnosisRun found;
  found.run = run;
  found.noise = {run.sigma, {}};
  found.accepted = {cause};
  Scenario scenario = LoadScenario(twinbench::test::ScenarioPath("rotary_4dof.toml"));
  RotaryOf(scenario).procedure.positions = kPositions;
  const nlohmann::json change = benches::rotary::ChangeOfTables(found, scenario);
  EXPECT_NEAR(change["target"]["dy_um"], 2.0, 1e-6);
  EXPECT_NEAR(change["reference"]["ez_arcsec"], 1.0, 1e-6);
  EXPECT_NEAR(change["target"]["ex_arcsec"], 0.0, 1e-9);
  EXPECT_FALSE(change["target"].contains("dz_um"));
}

// Sums as MeasureGain makes them, of errors whose truth is known.

struct Held {
  double power = 150.0;      // of the cause, in units of the noise: 600 readings, 0.5 of a deviation each
  double explained = 1.0;    // share of the cause's amplitude that the model has
  double noise = 1.0;        // true deviation over the stated one
  double correlation = 0.0;  // of neighbouring noise
  double fraction() const { return 1.0 - (1.0 - explained) * (1.0 - explained); }
};

/// 50 blocks of twelve readings; the cause is a slow wave.
std::vector<HeldOutSums> Blocks(const Held& held, std::uint64_t seed) {
  constexpr int kReadings = 600, kBlock = 12;
  Stream stream(seed, "held_out_test");
  std::vector<HeldOutSums> blocks(kReadings / kBlock);
  double noise = stream.Normal(), last = kNaN;
  for (int i = 0; i < kReadings; ++i) {
    const double innovation = std::sqrt(1.0 - held.correlation * held.correlation);
    if (i > 0) noise = held.correlation * noise + innovation * stream.Normal();
    const double signal = std::sqrt(2.0 * held.power / kReadings) * std::cos(0.05 * i);
    const double before = held.noise * noise + signal, after = before - held.explained * signal;
    HeldOutSums& block = blocks[static_cast<std::size_t>(i / kBlock)];
    block += {before * before, after * after, 1.0, 1.0};
    if (i > 0) block += {.steps = 0.5 * (after - last) * (after - last), .pairs = 1.0};
    last = after;
  }
  return blocks;
}

Gain GainBy(const std::vector<HeldOutSums>& blocks, bool noise_is_stated = true, double stated_correlation = 0.0) {
  Gain gain;
  FillGain(blocks, noise_is_stated, stated_correlation, gain);
  return gain;
}

struct Found {
  double mean;     // of the fraction
  double covered;  // share of the runs whose interval has the truth
  double positive;
};

Found Over(const Held& held, bool noise_is_stated, double stated_correlation = 0.0) {
  const Eigen::Array3d found = MeanOverSeeds(120, [&](std::uint64_t seed) {
    const Gain gain = GainBy(Blocks(held, seed), noise_is_stated, stated_correlation);
    const auto [lower, upper] = gain.interval95;
    const bool covers = lower <= held.fraction() && held.fraction() <= upper;
    return Eigen::Array3d(gain.fraction_removed, covers ? 1.0 : 0.0, gain.positive ? 1.0 : 0.0);
  });
  return {found[0], found[1], found[2]};
}

TEST(HeldOut, FractionIsRightOnAverageAlsoWhereTheNoiseIsLargerThanTheCause) {
  // The deflation scatters by sqrt(2 * 600) = 35 where 150 can be removed: 0.23 a run, 0.02 of the mean of 120.
  for (const double explained : {1.0, 0.7, 0.3}) {
    const Held held{.explained = explained};
    const Found found = Over(held, true);
    EXPECT_NEAR(found.mean, held.fraction(), 0.05) << explained;
    EXPECT_GE(found.covered, 0.90) << explained;  // 0.95 less two and a half deviations of 120 runs
    EXPECT_GT(found.positive, 0.999) << explained;
  }
}

TEST(HeldOut, NoiseThatIsOnlyEstimatedDoesNotCountAsRemovedOrLeft) {
  // With a noise that is 10 % larger than stated 0.21 * 600 would be left of 150: a fraction of 0.54.
  for (const double noise : {0.9, 1.1}) {
    EXPECT_GT(std::abs(Over({.noise = noise}, true).mean - 1.0), 0.3) << noise;
    const Found found = Over({.noise = noise}, false);
    EXPECT_NEAR(found.mean, 1.0, 0.05) << noise;
    EXPECT_GE(found.covered, 0.90) << noise;
  }
  EXPECT_NEAR(Over({.explained = 0.3}, false).mean, 0.51, 0.05);
}

TEST(HeldOut, CorrelatedNoiseIsNoRemainder) {
  // Neighbours differ by less than their noise says; ignored, 0.3 * 600 of 150 would be left.
  EXPECT_NEAR(Over({.power = 600.0, .correlation = 0.3}, false, 0.3).mean, 1.0, 0.05);
  EXPECT_LT(Over({.power = 600.0, .correlation = 0.3}, false).mean, 0.85);
}

/// Share of the runs in which what is stated of another run is right within 0.05.
double StatedRight(const Held& held) {
  return MeanOverSeeds(200, [&](std::uint64_t seed) {
    return std::abs(GainBy(Blocks(held, seed)).another_run - held.fraction()) < 0.05 ? 1.0 : 0.0;
  });
}

TEST(HeldOut, AnotherRunIsStatedWithinAFewPercentAlsoWhereWhatRemainsIsNoise) {
  // What remains scatters by 35 of 150 (above): as it is, one in six would be right.
  EXPECT_GT(StatedRight({}), 0.95);
  // Half of a cause of which 3000 can be removed leaves 750, by what is removed known to 3 %.
  EXPECT_GT(StatedRight({.power = 3000.0, .explained = 0.5}), 0.9);
}

TEST(HeldOut, NothingRemovedIsNoGain) {
  const Found found = Over({.power = 0.0}, true);
  EXPECT_EQ(found.positive, 0.0);
  const Gain gain = GainBy({{4.0, 4.0, 5.0, 1.0}});  // below the floor: nothing to remove
  EXPECT_TRUE(std::isnan(gain.fraction_removed));
  EXPECT_FALSE(gain.positive);
}

TEST(HeldOut, RmsIsInUnitsOfTheReadings) {
  const Gain gain = GainBy({{16.0, 4.0, 1.0, 1e12}});  // one row with a noise of 1 um
  EXPECT_NEAR(gain.before_m, 4e-6, 1e-18);
  EXPECT_NEAR(gain.after_m, 2e-6, 1e-18);
  EXPECT_NEAR(gain.noise_floor_m, 1e-6, 1e-18);
  EXPECT_NEAR(gain.fraction_removed, 12.0 / 15.0, 1e-12);
}

}  // namespace
}  // namespace twinbench::diagnose
