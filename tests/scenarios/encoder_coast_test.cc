#include <gtest/gtest.h>

#include "tests/scenarios/encoder_scenario_run.h"

// The answer that scenarios/encoder_coast.toml promises.
namespace twinbench {
namespace {

using test::EncoderScenarioRun, test::Figure;

EncoderScenarioRun Coasted(const std::vector<std::string>& overrides, Estimator estimator = Estimator::kRigorous) {
  return test::RunEncoderScenario("encoder_coast.toml", overrides, estimator);
}

double Chi2(const EncoderScenarioRun& run) {
  return Figure(run.Score(), "/device/ez/mean_chi2");
}

double AmplitudeOf(const nlohmann::json& results, const char* curve, std::size_t order) {
  return results.at("harmonics").at(curve).at(order - 1).at("amplitude_arcsec").get<double>();
}

// 360 places of a curve of 500 orders: mean of chi-squared 1, standard deviation 0.075; four of these.
constexpr double kChi2 = 0.3;

TEST(EncoderCoast, StatesTheUncertaintyOfThePaperAndHoldsIt) {
  const EncoderScenarioRun run = Coasted({});
  const nlohmann::json results = run.Results();
  EXPECT_NEAR(2.0 * Figure(results, "/curve_rms_u_arcsec"), 0.0061, 0.0002);
  EXPECT_NEAR(Figure(results, "/stamp_noise_ns"), 2.0, 0.02);
  EXPECT_EQ(results.at("harmonics").at("highest_order"), 500);
  EXPECT_NEAR(Chi2(run), 1.0, kChi2);
  EXPECT_NEAR(AmplitudeOf(results, "torque", 12), 0.05, 5e-4) << "a per cent: the speed of the fastest turn";
  EXPECT_NEAR(AmplitudeOf(results, "friction", 3), 0.1, 1e-3);
}

TEST(EncoderCoast, HoldsItOverSeeds) {
  constexpr int kSeeds = 4;
  double chi2 = 0.0;
  for (int seed = 1; seed <= kSeeds; ++seed)
    chi2 += Chi2(Coasted({"seed=" + std::to_string(seed), "encoder_procedure.turns=5"})) / kSeeds;
  EXPECT_NEAR(chi2, 1.0, kChi2 / 2.0);
}

TEST(EncoderCoast, AtOneSpeedMistakesTheTorqueForTheRingAndSaysSo) {
  const EncoderScenarioRun run = Coasted({"encoder_procedure.speeds_deg_s=[1800]", "encoder_procedure.turns=6"});
  EXPECT_FALSE(run.Results().at("not_separable").empty());
  EXPECT_GT(Figure(run.Score(), "/device/ez/rms_error_arcsec"), 0.03) << "0.05 / sqrt(2)";
}

TEST(EncoderCoast, IsLessCertainByThePublishedEquations) {
  const EncoderScenarioRun run = Coasted({"encoder_procedure.turns=6"}, Estimator::kPublished);
  const double chi2 = Chi2(run);
  EXPECT_LT(chi2, 1.3) << "turns share the times that close them; counted as independent";
  EXPECT_GT(chi2, 0.3);
}

TEST(EncoderCoast, RefusesASpindleThatWouldStandStill) {
  EXPECT_THROW(Coasted({"spindle.viscous_per_s=0.5"}), InputError);
  EXPECT_THROW(Coasted({"encoder_procedure.heads_deg=[0, 90]"}), InputError);
}

}  // namespace
}  // namespace twinbench
