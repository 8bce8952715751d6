#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/support/twin_run.h"
#include "twin/benches/encoder_comparison/bench.h"

// The answer that scenarios/encoder_heads.toml promises.
namespace twinbench {
namespace {

struct Scored {
  nlohmann::json results, score;
};

Scored HeadsRun(const std::vector<std::string>& overrides, Estimator estimator = Estimator::kRigorous) {
  const Scenario scenario = LoadScenario(test::ScenarioPath("encoder_heads.toml"), overrides);
  const std::vector<Reading> readings = test::RunEncoderTwin(scenario).readings;
  const nlohmann::json truth = sim::EncoderTwin(scenario).Truth();
  return {benches::encoder::Evaluate(scenario, readings, estimator).results,
          benches::encoder::ScoreRun(scenario, readings, truth, estimator).json};
}

double Figure(const nlohmann::json& json, const char* path) {
  return json.at(nlohmann::json::json_pointer(path)).get<double>();
}

const std::vector<std::string> kFiveHeads = {"encoder_procedure.heads_deg=[0, 90, 180, 270, 37]"};

TEST(EncoderHeads, CalibrateTheRingButForTheMultiplesOfFour) {
  const Scored run = HeadsRun({});
  EXPECT_EQ(run.results.at("lost").at("orders").size(), 16u);
  EXPECT_NEAR(2.0 * Figure(run.results, "/lost/curve_rms_u_arcsec"), 0.0053, 0.0004);
  // 45 orders seen: 2 parts each, 0.15; three of these.
  EXPECT_NEAR(Figure(run.score, "/device/ez/mean_chi2"), 1.0, 0.45);
  EXPECT_GT(Figure(run.score, "/lost/rms_arcsec"), 0.025) << "U = 0.05 arcsec (k = 2) does not hold for this ring";
  EXPECT_LT(Figure(run.score, "/reference/ez/rms_error_arcsec"), 0.2);
}

TEST(EncoderHeads, CalibrateAllOfItWithAFifthAtAnOddAngle) {
  const Scored run = HeadsRun(kFiveHeads);
  EXPECT_TRUE(run.results.at("lost").at("orders").empty());
  EXPECT_LT(2.0 * Figure(run.results, "/lost/whole_curve_rms_u_arcsec"), 0.011);
  EXPECT_NEAR(Figure(run.score, "/device/ez/mean_chi2"), 1.0, 0.45);
}

/// Rounded alike in every pass.
TEST(EncoderHeads, KnowTheRingNoBetterThanInTheirSteps) {
  for (const int bits : {15, 17, 18, 19, 22}) {
    std::vector<std::string> heads = kFiveHeads;
    heads.push_back(fmt::format("device.resolution_deg={:.17g}", 360.0 / (1 << bits)));
    const double chi2 = Figure(HeadsRun(heads).score, "/device/ez/mean_chi2");
    EXPECT_GT(chi2, 0.2) << bits;
    EXPECT_LT(chi2, 4.0) << bits;
  }
}

TEST(EncoderHeads, AreAsCertainInMotion) {
  std::vector<std::string> sweep = kFiveHeads;
  sweep.insert(sweep.end(), {"encoder_procedure.kind=sweep", "encoder_procedure.passes=[1]",
                             "encoder_procedure.speeds_deg_s=[12.0]", "encoder_procedure.turns=2"});
  const Scored run = HeadsRun(sweep);
  EXPECT_NEAR(Figure(run.score, "/device/ez/mean_chi2"), 1.0, 0.45);
}

TEST(EncoderHeads, HoldTheWholeCurveOverRingsOnlyWithTheAssumptionAboutLostOrders) {
  // (error / u)^2 of the whole curve: with what the lost orders are assumed to be, and without.
  constexpr int kRings = 30;
  double assumed2 = 0.0, lost2 = 0.0;
  for (int seed = 1; seed <= kRings; ++seed) {
    const Scored run = HeadsRun({fmt::format("seed={}", seed), "encoder_procedure.passes=[1]"});
    lost2 += std::pow(Figure(run.score, "/lost/rms_arcsec"), 2) / kRings;
    assumed2 += std::pow(Figure(run.results, "/lost/assumed_rms_arcsec"), 2) / kRings;
  }
  // A sum of few orders' squares: 30 rings with 2 parts of about two orders that count each, 18 % of the variance.
  EXPECT_NEAR(lost2 / assumed2, 1.0, 0.6);
}

TEST(EncoderHeads, GiveTheSameByThePublishedEquationsLessCertainly) {
  const Scored rigorous = HeadsRun({}), published = HeadsRun({}, Estimator::kPublished);
  const double ratio = Figure(published.results, "/lost/curve_rms_u_arcsec") /
                       Figure(rigorous.results, "/lost/curve_rms_u_arcsec");
  EXPECT_NEAR(ratio, std::sqrt(3.0), 0.1);
  EXPECT_NEAR(Figure(published.score, "/device/ez/mean_chi2"), 1.0, 0.45);
}

}  // namespace
}  // namespace twinbench
