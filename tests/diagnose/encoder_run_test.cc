#include "tests/core/input_error.h"
#include "tests/diagnose/encoder_fit.h"
#include "tests/diagnose/support/synthetic_run.h"
#include "tests/support/over_seeds.h"
#include "twin/core/stream.h"
#include "twin/diagnose/engine/series_sums.h"

namespace twinbench::diagnose::encoder {
namespace {

using twinbench::test::EncoderEffect, twinbench::test::EncoderScenario, twinbench::test::ReadingsWith;
using twinbench::test::RunEncoderTwin;
using units::deg;

Scenario NoisyScenario(const std::string& kind = "stops") {
  Scenario scenario = EncoderScenario(kind);
  scenario.noise_free = false;
  return scenario;
}

/// Readings that a test alters.
struct Noisy {
  explicit Noisy(const Scenario& s = NoisyScenario()) : scenario(s), readings(RunEncoderTwin(s).readings) {}
  EncoderRun Run() const { return RunOf(readings, scenario); }
  double Noise_rad() const { return EncoderOf(scenario).device.noise_rad; }

  Scenario scenario;
  std::vector<Reading> readings;
};

TEST(EncoderRun, IsOneChannelWithOneOffsetASetUp) {
  Scenario scenario = NoisyScenario();
  EncoderOf(scenario).encoder_procedure.mounting_rad = {0.0, 2.0};
  const LinearRun run = Noisy(scenario).Run().run;
  EXPECT_THAT(run.channels, testing::ElementsAre("angle"));
  EXPECT_EQ(run.Rows(), 2 * 576);
  EXPECT_EQ(run.nuisance.jacobian.cols(), 2);
  EXPECT_NEAR(run.observed[600] - run.schedule.reference_rad[600], 2.0, 5.0 * EncoderOf(scenario).device.noise_rad);
  const Projector projector(run.nuisance.jacobian / run.sigma[0], run.nuisance);
  EXPECT_NEAR(projector.DegreesOfFreedom(), run.Rows() - 2, 1e-3);
}

TEST(EncoderRun, PutsBackTheTurnsThatADeviceDoesNotCount) {
  Noisy noisy;
  const EncoderRun counted = noisy.Run();
  for (Reading& r : noisy.readings) r.measured_rad = std::fmod(r.measured_rad + 1.0, 2.0 * units::kPi);
  EXPECT_LT((noisy.Run().run.residual - counted.run.residual).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(EncoderRun, LeavesOutAndCountsReadingsWithoutAValue) {
  Noisy noisy;
  noisy.readings[3].measured_rad = kNaN;
  noisy.readings[4].status = ReadingStatus::kMissing;
  const EncoderRun encoder = noisy.Run();
  EXPECT_EQ(encoder.left_out, 2);
  EXPECT_EQ(encoder.run.Rows(), 574);
  EXPECT_EQ(encoder.run.schedule.reading[3], 5);
  std::for_each(noisy.readings.begin() + 8, noisy.readings.end(), [](Reading& r) { r.measured_rad = kNaN; });
  EXPECT_EQ(MessageOf([&] { noisy.Run(); }), "readings: 6 of 576 have a value; expected at least 8");
}

TEST(EncoderRun, EstimatesTheNoiseUnderEveryEffect) {
  for (const char* kind : {"stops", "sweep"}) {
    Scenario scenario = NoisyScenario(kind);
    EncoderOf(scenario).device.lines = 90;
    for (const EffectEntry& entry : EffectCatalogue(kEncoderBench)) {
      const auto readings = ReadingsWith(scenario, EncoderEffect(entry.name));
      const double ratio = RunOf(readings, scenario).run.sigma[0] / EncoderOf(scenario).device.noise_rad;
      // A median of 140 differences and more: 10 %, some of it low because the smaller estimate counts. Structure
      // of high orders enlarges it; a factor 3 does not hide it, for its amplitude is 5 times the noise.
      EXPECT_GT(ratio, 0.8) << entry.name << " " << kind;
      EXPECT_LT(ratio, 3.0) << entry.name << " " << kind;
    }
  }
}

/// Estimated over true noise of one seed, with every fiftieth reading `outlier` deviations off.
double NoiseRatio(const std::string& kind, std::uint64_t seed, double outlier = 0.0) {
  Scenario scenario = NoisyScenario(kind);
  scenario.seed = seed;
  Noisy noisy(scenario);
  for (std::size_t i = 0; i < noisy.readings.size(); i += 50)
    noisy.readings[i].measured_rad += outlier * noisy.Noise_rad();
  return noisy.Run().run.sigma[0] / noisy.Noise_rad();
}

TEST(EncoderRun, EstimatesTheNoiseToThePrecisionThatTheReadingsAllowWithoutItsOutliers) {
  const Eigen::Array2d off = twinbench::test::MeanOverSeeds(60, [](std::uint64_t seed) {
    const double ratio = NoiseRatio("stops", seed);
    return Eigen::Array2d(ratio - 1.0, std::pow(ratio - 1.0, 2));
  });
  // 576 readings, second differences: 1 / sqrt(576) = 4.2 % a run, 0.5 % of the mean. A median scatters by 6 %.
  EXPECT_NEAR(off[0], 0.0, 0.015);
  EXPECT_LT(std::sqrt(off[1]), 0.05);
  for (const char* kind : {"stops", "sweep"})
    EXPECT_NEAR(NoiseRatio(kind, 1, 20.0), NoiseRatio(kind, 1), 0.05) << kind;
}

TEST(EncoderRun, WeighsReadingsByTheSamplesThatTheyAreMeansOf) {
  Noisy sweep(EncoderScenario("sweep"));
  Stream stream(9, "test.samples");
  constexpr double kOfSample_rad = 1e-4;
  for (Reading& r : sweep.readings) {
    r.n_samples = r.reading % 5 == 0 ? 1 : 100;  // a block that ended at once
    r.measured_rad += kOfSample_rad / std::sqrt(r.n_samples) * stream.Normal();
  }
  const LinearRun run = sweep.Run().run;
  EXPECT_NEAR(run.sigma[0] / run.sigma[1], 10.0, 1e-9);
  // Some 4000 differences that share readings: 2 % at one standard deviation.
  EXPECT_NEAR(run.sigma[0] / kOfSample_rad, 1.0, 0.06);
}

TEST(EncoderRun, TakesTheNoiseThatIsKnown) {
  Scenario scenario = NoisyScenario();
  EncoderOf(scenario).device.noise_known = true;
  const LinearRun run = Noisy(scenario).Run().run;
  EXPECT_TRUE(run.sigma_stated);
  EXPECT_EQ(run.sigma[0], EncoderOf(scenario).device.noise_rad);
}

TEST(EncoderRun, DerivesVelocitiesOfASweepThatWereNotRecordedAndNoneOfStopsWhereTimeIsAnOrderOnly) {
  Noisy sweep(NoisyScenario("sweep"));
  const Eigen::VectorXd recorded = sweep.Run().context.velocity_rad_s;
  for (Reading& r : sweep.readings) r.velocity_rad_s = kNaN;
  const Eigen::VectorXd derived = sweep.Run().context.velocity_rad_s;
  // Central differences are wrong where the acceleration sets in: 60 deg/s^2 * 80 ms / 2.
  EXPECT_LT((derived - recorded).cwiseAbs().maxCoeff(), 2.5 * deg);
  Noisy stops;
  for (Reading& r : stops.readings) r.velocity_rad_s = kNaN;
  EXPECT_FALSE(stops.Run().context.Moves());
}

// Sums of series that are never written out, against those of the series.

/// Two mountings, read in motion.
LinearRun SweepsOf(std::vector<Family>& families) {
  Scenario scenario = EncoderScenario("sweep");
  EncoderOf(scenario).encoder_procedure.mounting_rad = {0.0, 1.3};
  EncoderOf(scenario).encoder_procedure.interval_s = 1.8;
  const EncoderRun encoder =
      RunOf(ReadingsWith(scenario, EncoderEffect("periodic")), scenario);
  families = Families(encoder);
  return encoder.run;
}

Eigen::MatrixXd Dense(const Banded& T) {
  Eigen::MatrixXd dense = T.diagonal.asDiagonal();
  for (Eigen::Index k = 1; k <= std::ssize(T.beside); ++k) {
    const Eigen::VectorXd& beside = T.beside[static_cast<std::size_t>(k - 1)];
    dense.diagonal(k) = beside.head(beside.size() - k);
    dense.diagonal(-k) = beside.head(beside.size() - k);
  }
  return dense;
}

void ExpectSums(const Base& base, const std::string& name, const NoiseModel& noise, const LinearRun& run) {
  const auto sums = base.sums();
  const Eigen::MatrixXd Y = RandomMatrix("Y", run.Rows(), 2), products = sums->Products(Y);
  const Banded T = noise.Precision(run);
  const Eigen::MatrixXd dense = Dense(T);
  const std::vector<Eigen::MatrixXd> squares = sums->Squares(T);
  ASSERT_EQ(std::ssize(squares), base.grid);
  for (int g = 0; g < base.grid; g += 1 + base.grid / 20) {
    const Eigen::MatrixXd S = base.series(g), square = S.transpose() * dense * S;
    const double length = S.norm() * Y.norm();
    EXPECT_LT((products.middleRows(g * S.cols(), S.cols()) - S.transpose() * Y).norm(), 1e-11 * length)
        << name << g;
    EXPECT_LT((squares[static_cast<std::size_t>(g)] - square).norm(),
              1e-11 * S.squaredNorm() * T.diagonal.maxCoeff())
        << name << " " << g;
  }
}

TEST(SeriesSums, AreThoseOfTheSeriesThatAreNotWrittenOut) {
  std::vector<Family> families;
  const LinearRun run = SweepsOf(families);
  NoiseModel noise{run.sigma, {{0.4, -0.3, 0.2}}};
  for (int k = 0; k < run.Rows(); ++k) noise.sigma[k] *= 1.0 + 0.1 * (k % 7);
  std::set<std::string> seen;
  for (const Family& family : families) {
    if (!family.base || !family.base->sums) continue;
    ExpectSums(*family.base, family.effect, noise, run);
    seen.insert(family.effect);
  }
  for (const char* effect : {"periodic", "reference_fault", "slip", "line", "tone", "step", "touch",
                             "speed harmonic", "direction harmonic", "growing harmonic"})
    EXPECT_TRUE(seen.contains(effect)) << effect;
}

}  // namespace
}  // namespace twinbench::diagnose::encoder
