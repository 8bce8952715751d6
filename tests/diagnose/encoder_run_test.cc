#include "tests/core/input_error.h"
#include "tests/diagnose/encoder_fit.h"
#include "twin/core/stream.h"
#include "twin/diagnose/engine/projector.h"

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

TEST(EncoderRun, IsOneChannelWithOneOffsetASetUp) {
  Scenario scenario = NoisyScenario();
  EncoderOf(scenario).encoder_procedure.mounting_rad = {0.0, 2.0};
  const EncoderRun encoder = RunOf(RunEncoderTwin(scenario).readings, scenario);
  const LinearRun& run = encoder.run;
  EXPECT_THAT(run.channels, testing::ElementsAre("angle"));
  EXPECT_EQ(run.Rows(), 2 * 576);
  EXPECT_EQ(run.nuisance.jacobian.cols(), 2);
  EXPECT_NEAR(run.observed[600] - run.schedule.reference_rad[600], 2.0, 5.0 * EncoderOf(scenario).device.noise_rad);
  const Projector projector(run.nuisance.jacobian / run.sigma[0], run.nuisance);
  EXPECT_NEAR(projector.DegreesOfFreedom(), run.Rows() - 2, 1e-3);
}

TEST(EncoderRun, PutsBackTheTurnsThatADeviceDoesNotCount) {
  const Scenario scenario = NoisyScenario();
  auto readings = RunEncoderTwin(scenario).readings;
  const EncoderRun counted = RunOf(readings, scenario);
  for (Reading& r : readings) r.measured_rad = std::fmod(r.measured_rad + 1.0, 2.0 * units::kPi);
  const EncoderRun wrapped = RunOf(readings, scenario);
  EXPECT_LT((wrapped.run.residual - counted.run.residual).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(EncoderRun, LeavesOutAndCountsReadingsWithoutAValue) {
  const Scenario scenario = NoisyScenario();
  auto readings = RunEncoderTwin(scenario).readings;
  readings[3].measured_rad = kNaN;
  readings[4].status = ReadingStatus::kMissing;
  const EncoderRun encoder = RunOf(readings, scenario);
  EXPECT_EQ(encoder.left_out, 2);
  EXPECT_EQ(encoder.run.Rows(), 574);
  EXPECT_EQ(encoder.run.schedule.reading[3], 5);
  for (std::size_t i = 8; i < readings.size(); ++i) readings[i].measured_rad = kNaN;
  EXPECT_EQ(MessageOf([&] { RunOf(readings, scenario); }), "readings: 6 of 576 have a value; expected at least 8");
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
  auto readings = RunEncoderTwin(scenario).readings;
  for (std::size_t i = 0; i < readings.size(); i += 50)
    readings[i].measured_rad += outlier * EncoderOf(scenario).device.noise_rad;
  return RunOf(readings, scenario).run.sigma[0] / EncoderOf(scenario).device.noise_rad;
}

TEST(EncoderRun, EstimatesTheNoiseToThePrecisionThatTheReadingsAllow) {
  constexpr int kRuns = 60;
  double mean = 0.0, square = 0.0;
  for (int seed = 1; seed <= kRuns; ++seed) {
    const double ratio = NoiseRatio("stops", seed);
    mean += ratio / kRuns;
    square += (ratio - 1.0) * (ratio - 1.0) / kRuns;
  }
  // 576 readings, second differences: 1 / sqrt(576) = 4.2 % a run, 0.5 % of the mean. A median scatters by 6 %.
  EXPECT_NEAR(mean, 1.0, 0.015);
  EXPECT_LT(std::sqrt(square), 0.05);
}

TEST(EncoderRun, EstimatesTheNoiseWithoutItsOutliers) {
  for (const char* kind : {"stops", "sweep"})
    EXPECT_NEAR(NoiseRatio(kind, 1, 20.0), NoiseRatio(kind, 1), 0.05) << kind;
}

TEST(EncoderRun, WeighsReadingsByTheSamplesThatTheyAreMeansOf) {
  Scenario scenario = EncoderScenario("sweep");
  auto readings = RunEncoderTwin(scenario).readings;
  Stream stream(9, "test.samples");
  constexpr double kOfSample_rad = 1e-4;
  for (std::size_t i = 0; i < readings.size(); ++i) {
    readings[i].n_samples = i % 5 == 0 ? 1 : 100;  // a block that ended at once
    readings[i].measured_rad += kOfSample_rad / std::sqrt(readings[i].n_samples) * stream.Normal();
  }
  const LinearRun run = RunOf(readings, scenario).run;
  EXPECT_NEAR(run.sigma[0] / run.sigma[1], 10.0, 1e-9);
  // Some 4000 differences that share readings: 2 % at one standard deviation.
  EXPECT_NEAR(run.sigma[0] / kOfSample_rad, 1.0, 0.06);
}

TEST(EncoderRun, TakesTheNoiseThatIsKnown) {
  Scenario scenario = NoisyScenario();
  EncoderOf(scenario).device.noise_known = true;
  const EncoderRun encoder = RunOf(RunEncoderTwin(scenario).readings, scenario);
  EXPECT_TRUE(encoder.run.sigma_stated);
  EXPECT_EQ(encoder.run.sigma[0], EncoderOf(scenario).device.noise_rad);
}

TEST(EncoderRun, DerivesVelocitiesOfASweepThatWereNotRecorded) {
  const Scenario scenario = NoisyScenario("sweep");
  auto readings = RunEncoderTwin(scenario).readings;
  const Eigen::VectorXd recorded = RunOf(readings, scenario).context.velocity_rad_s;
  for (Reading& r : readings) r.velocity_rad_s = kNaN;
  const Eigen::VectorXd derived = RunOf(readings, scenario).context.velocity_rad_s;
  // Central differences are wrong where the acceleration sets in: 60 deg/s^2 * 80 ms / 2.
  EXPECT_LT((derived - recorded).cwiseAbs().maxCoeff(), 2.5 * deg);
}

TEST(EncoderRun, OfStopsHasNoVelocityWhereTimeIsAnOrderOnly) {
  const Scenario scenario = NoisyScenario();
  auto readings = RunEncoderTwin(scenario).readings;
  for (Reading& r : readings) r.velocity_rad_s = kNaN;
  EXPECT_FALSE(RunOf(readings, scenario).context.Moves());
}

}  // namespace
}  // namespace twinbench::diagnose::encoder
