#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/scenarios/encoder_scenario_run.h"

// The answer that scenarios/encoder_heads.toml promises.
namespace twinbench {
namespace {

using test::EncoderScenarioRun, test::Figure;

EncoderScenarioRun HeadsRun(const std::vector<std::string>& overrides, Estimator estimator = Estimator::kRigorous) {
  return test::RunEncoderScenario("encoder_heads.toml", overrides, estimator);
}

const std::vector<std::string> kFiveHeads = {"encoder_procedure.heads_deg=[0, 90, 180, 270, 37]"};

TEST(EncoderHeads, CalibrateTheRingButForTheMultiplesOfFour) {
  const EncoderScenarioRun run = HeadsRun({});
  const nlohmann::json results = run.Results(), score = run.Score();
  EXPECT_EQ(results.at("lost").at("orders").size(), 16u);
  EXPECT_NEAR(2.0 * Figure(results, "/lost/curve_rms_u_arcsec"), 0.0053, 0.0004);
  // 45 orders seen: 2 parts each, 0.15; three of these.
  EXPECT_NEAR(Figure(score, "/device/ez/mean_chi2"), 1.0, 0.45);
  EXPECT_GT(Figure(score, "/lost/rms_arcsec"), 0.025) << "U = 0.05 arcsec (k = 2) does not hold for this ring";
  EXPECT_LT(Figure(score, "/reference/ez/rms_error_arcsec"), 0.2);
}

TEST(EncoderHeads, CalibrateAllOfItWithAFifthAtAnOddAngle) {
  const EncoderScenarioRun run = HeadsRun(kFiveHeads);
  const nlohmann::json results = run.Results();
  EXPECT_TRUE(results.at("lost").at("orders").empty());
  EXPECT_LT(2.0 * Figure(results, "/lost/whole_curve_rms_u_arcsec"), 0.011);
  EXPECT_NEAR(Figure(run.Score(), "/device/ez/mean_chi2"), 1.0, 0.45);
}

/// Rounded alike in every pass.
TEST(EncoderHeads, KnowTheRingNoBetterThanInTheirSteps) {
  for (const int bits : {15, 17, 18, 19, 22}) {
    std::vector<std::string> heads = kFiveHeads;
    heads.push_back(fmt::format("device.resolution_deg={:.17g}", 360.0 / (1 << bits)));
    const double chi2 = Figure(HeadsRun(heads).Score(), "/device/ez/mean_chi2");
    EXPECT_GT(chi2, 0.2) << bits;
    EXPECT_LT(chi2, 4.0) << bits;
  }
}

TEST(EncoderHeads, AreAsCertainInMotion) {
  std::vector<std::string> sweep = kFiveHeads;
  sweep.insert(sweep.end(), {"encoder_procedure.kind=sweep", "encoder_procedure.passes=[1]",
                             "encoder_procedure.speeds_deg_s=[12.0]", "encoder_procedure.turns=2"});
  EXPECT_NEAR(Figure(HeadsRun(sweep).Score(), "/device/ez/mean_chi2"), 1.0, 0.45);
}

TEST(EncoderHeads, HoldTheWholeCurveOverRingsOnlyWithTheAssumptionAboutLostOrders) {
  // (error / u)^2 of the whole curve: with what the lost orders are assumed to be, and without.
  constexpr int kRings = 30;
  double assumed2 = 0.0, lost2 = 0.0;
  for (int seed = 1; seed <= kRings; ++seed) {
    const EncoderScenarioRun run = HeadsRun({fmt::format("seed={}", seed), "encoder_procedure.passes=[1]"});
    lost2 += std::pow(Figure(run.Score(), "/lost/rms_arcsec"), 2) / kRings;
    assumed2 += std::pow(Figure(run.Results(), "/lost/assumed_rms_arcsec"), 2) / kRings;
  }
  // A sum of few orders' squares: 30 rings with 2 parts of about two orders that count each, 18 % of the variance.
  EXPECT_NEAR(lost2 / assumed2, 1.0, 0.6);
}

TEST(EncoderHeads, GiveTheSameByThePublishedEquationsLessCertainly) {
  const EncoderScenarioRun rigorous = HeadsRun({}), published = HeadsRun({}, Estimator::kPublished);
  const double ratio = Figure(published.Results(), "/lost/curve_rms_u_arcsec") /
                       Figure(rigorous.Results(), "/lost/curve_rms_u_arcsec");
  EXPECT_NEAR(ratio, std::sqrt(3.0), 0.1);
  EXPECT_NEAR(Figure(published.Score(), "/device/ez/mean_chi2"), 1.0, 0.45);
}

}  // namespace
}  // namespace twinbench
