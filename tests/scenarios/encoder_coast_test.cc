#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/support/twin_run.h"
#include "twin/benches/encoder_comparison/bench.h"

// The answer that scenarios/encoder_coast.toml promises.
namespace twinbench {
namespace {

struct CoastRun {
  nlohmann::json results, score;
};

CoastRun Coasted(const std::vector<std::string>& overrides, Estimator estimator = Estimator::kRigorous) {
  const Scenario scenario = LoadScenario(test::ScenarioPath("encoder_coast.toml"), overrides);
  const std::vector<Reading> readings = test::RunEncoderTwin(scenario).readings;
  const nlohmann::json truth = sim::EncoderTwin(scenario).Truth();
  return {benches::encoder::Evaluate(scenario, readings, estimator).results,
          benches::encoder::ScoreRun(scenario, readings, truth, estimator).json};
}

double Chi2(const CoastRun& run) {
  return run.score.at("device").at("ez").at("mean_chi2").get<double>();
}

double AmplitudeOf(const CoastRun& run, const char* curve, std::size_t order) {
  return run.results.at("harmonics").at(curve).at(order - 1).at("amplitude_arcsec").get<double>();
}

// 360 places of a curve of 500 orders: mean of chi-squared 1, standard deviation 0.075; four of these.
constexpr double kChi2 = 0.3;

TEST(EncoderCoast, StatesTheUncertaintyOfThePaperAndHoldsIt) {
  const CoastRun run = Coasted({});
  EXPECT_NEAR(2.0 * run.results.at("curve_rms_u_arcsec").get<double>(), 0.0061, 0.0002);
  EXPECT_NEAR(run.results.at("stamp_noise_ns").get<double>(), 2.0, 0.02);
  EXPECT_EQ(run.results.at("harmonics").at("highest_order"), 500);
  EXPECT_NEAR(Chi2(run), 1.0, kChi2);
  EXPECT_NEAR(AmplitudeOf(run, "torque", 12), 0.05, 5e-4) << "a per cent: the speed of the fastest turn";
  EXPECT_NEAR(AmplitudeOf(run, "friction", 3), 0.1, 1e-3);
}

TEST(EncoderCoast, HoldsItOverSeeds) {
  constexpr int kSeeds = 4;
  double chi2 = 0.0;
  for (int seed = 1; seed <= kSeeds; ++seed)
    chi2 += Chi2(Coasted({"seed=" + std::to_string(seed), "encoder_procedure.turns=5"})) / kSeeds;
  EXPECT_NEAR(chi2, 1.0, kChi2 / 2.0);
}

TEST(EncoderCoast, AtOneSpeedMistakesTheTorqueForTheRingAndSaysSo) {
  const CoastRun run = Coasted({"encoder_procedure.speeds_deg_s=[1800]", "encoder_procedure.turns=6"});
  EXPECT_FALSE(run.results.at("not_separable").empty());
  EXPECT_GT(run.score.at("device").at("ez").at("rms_error_arcsec").get<double>(), 0.03) << "0.05 / sqrt(2)";
}

TEST(EncoderCoast, IsLessCertainByThePublishedEquations) {
  const CoastRun run = Coasted({"encoder_procedure.turns=6"}, Estimator::kPublished);
  EXPECT_LT(Chi2(run), 1.3) << "turns share the times that close them; counted as independent";
  EXPECT_GT(Chi2(run), 0.3);
}

TEST(EncoderCoast, RefusesASpindleThatWouldStandStill) {
  EXPECT_THROW(Coasted({"spindle.viscous_per_s=0.5"}), InputError);
  EXPECT_THROW(Coasted({"encoder_procedure.heads_deg=[0, 90]"}), InputError);
}

}  // namespace
}  // namespace twinbench
