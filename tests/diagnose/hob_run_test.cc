#include <gtest/gtest.h>

#include <cmath>

#include "tests/diagnose/hob_chain.h"
#include "twin/benches/hob_transmission/bench.h"
#include "twin/benches/hob_transmission/settings.h"
#include "twin/core/errors.h"
#include "twin/core/linear_algebra.h"
#include "twin/core/units.h"

namespace twinbench::diagnose::hob {
namespace {

using test::HobChain;
using units::arcsec, units::deg;

HobChain Quiet() {
  HobChain chain;
  chain.table_noise_arcsec = chain.hob_noise_arcsec = 0.0;
  chain.hob_steps = false;
  chain.turns = 1;
  return chain;
}

LinearRun RunOf(const std::vector<Reading>& readings, const Scenario& scenario) {
  return benches::hob::Linear(readings, scenario, Estimator::kRigorous);
}

/// Rms that the free unknowns leave.
double Left_rad(const LinearRun& run) {
  const Eigen::MatrixXd free = run.nuisance.jacobian.toDense();
  const Eigen::VectorXd left = run.residual - free * SolveShortest(free, run.residual);
  return left.norm() / std::sqrt(static_cast<double>(left.size()));
}

/// The ring's geometry: its middle is off by e towards azimuth A on it, where azimuths run against its angle s. The
/// line under the head then has the azimuth -(s + e / R sin(s + A)): it shows e / R cos(s + A - 90 deg) too much.
TEST(HobRun, TakesOffTheStatedEccentricityOfTheRing) {
  const double amplitude_rad = 6.0 * arcsec;
  HobChain chain = Quiet();
  chain.hidden = {{"eccentricity", "table", {{"amplitude", amplitude_rad}, {"phase", 40.0 * deg - 90.0 * deg}}}};
  Scenario scenario = ScenarioOf(chain);
  HobOf(scenario).table_encoder.radius_m = 0.1;
  HobOf(scenario).table_encoder.eccentricity_m = 0.1 * amplitude_rad;
  HobOf(scenario).table_encoder.eccentricity_azimuth_rad = 40.0 * deg;
  EXPECT_LT(Left_rad(RunOf(ReadingsOf(chain), scenario)), 1e-3 * arcsec);
}

TEST(HobRun, TakesOffAnEmpiricalSignal) {
  const HobChain chain = Quiet();
  std::vector<Reading> readings = ReadingsOf(chain);
  Scenario scenario = ScenarioOf(chain);
  EmpiricalSettings signal;
  signal.channel = "transmission";
  for (Reading& r : readings) {
    const double value_rad = 2.0 * arcsec * std::sin(0.01 * r.reading);
    r.measured_rad += value_rad;
    signal.reading.push_back(r.reading);
    signal.value_rad.push_back(value_rad);
  }
  EXPECT_GT(Left_rad(RunOf(readings, scenario)), 0.5 * arcsec);
  scenario.empiricals = {signal};
  EXPECT_LT(Left_rad(RunOf(readings, scenario)), 1e-3 * arcsec);
}

TEST(HobRun, TakesSamplesTogetherAsFarAsTheWormKeepsItsSize) {
  HobChain chain;
  const LinearRun run = RunOf(ReadingsOf(chain), ScenarioOf(chain));
  // A mean over three of 720 samples leaves sin(3 x) / (3 sin x) = 0.805 of order 90 (x = 22.5 deg); over four
  // 0.65.
  EXPECT_EQ(run.Rows(), 2 * 2 * 3 * 240);
  // Noise of one sample: 0.1 arcsec of the table, 0.5 / 22 of the hob, and the hob's steps of 1.44 / 22 / sqrt(12).
  EXPECT_NEAR(run.sigma[0] / arcsec, std::hypot(0.1, 0.5 / 22.0, 1.44 / 22.0 / std::sqrt(12.0)) / std::sqrt(3.0),
              1e-6);
  EXPECT_TRUE(run.sigma_stated);
}

TEST(HobRun, EstimatesANoiseThatNobodyTold) {
  HobChain chain;
  chain.noise_told = false;
  chain.hidden = {{"worm", "", {{"amplitude", 2.0 * arcsec}, {"phase", 3.0}}}};  // repeats from turn to turn
  const std::vector<Reading> readings = ReadingsOf(chain);
  const LinearRun run = RunOf(readings, ScenarioOf(chain));
  EXPECT_FALSE(run.sigma_stated);
  const double truth_rad = std::hypot(0.1, 0.5 / 22.0, 1.44 / 22.0 / std::sqrt(12.0)) * arcsec;
  // 8640 samples say 1 / sqrt(8640) = 1 %; what repeats of the steps' errors from turn to turn is not seen: 3 %.
  const double together = static_cast<double>(readings.size()) / run.Rows();
  EXPECT_NEAR(run.sigma[0] * std::sqrt(together) / truth_rad, 1.0, 0.06);
}

TEST(HobRun, LeavesOutSamplesThatLieFarOutsideButNoStep) {
  HobChain chain;
  chain.hidden = {{"outliers", "", {{"fraction", 0.003}, {"size", 10.0 * arcsec}}},
                  {"slip", "table", {{"step", 72.0 * arcsec}, {"at_reading", 2000.0}}}};
  const std::vector<Reading> readings = ReadingsOf(chain);
  chain.hidden.erase(chain.hidden.begin());
  const std::vector<Reading> without = ReadingsOf(chain);
  int far = 0;  // beyond ten deviations of the noise of a sample
  for (std::size_t i = 0; i < readings.size(); ++i)
    far += std::abs(readings[i].measured_rad - without[i].measured_rad) > 1.0 * arcsec;
  const LinearRun run = RunOf(readings, ScenarioOf(chain));
  // A row is the mean of three samples at most, and says by its noise of how many.
  const double used = 3.0 * (run.sigma.minCoeff() / run.sigma.array()).square().sum();
  const int left_out = static_cast<int>(readings.size()) - static_cast<int>(std::lround(used));
  EXPECT_GE(left_out, far);
  EXPECT_LE(left_out, far + 3);  // of smaller ones one in twenty is as far
}

TEST(HobRun, NeedsTheHeadOfEverySetUp) {
  HobChain chain = Quiet();
  std::vector<Reading> readings = ReadingsOf(chain);
  readings[20].head_rad = kNaN;
  EXPECT_THROW(RunOf(readings, ScenarioOf(chain)), InputError);
}

}  // namespace
}  // namespace twinbench::diagnose::hob
