#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/support/twin_run.h"
#include "twin/benches/encoder_comparison/bench.h"
#include "twin/benches/encoder_comparison/estimators/device_error.h"

// The answer that scenarios/encoder_mountings.toml promises, and the same device in continuous motion.
namespace twinbench {
namespace {

using separate::encoder::DeviceError, separate::harmonics::Amplitude, units::arcsec;

struct Compared {
  DeviceError found;
  nlohmann::json truth;
};

Compared Compare(const std::vector<std::string>& overrides) {
  const Scenario scenario = LoadScenario(test::ScenarioPath("encoder_mountings.toml"), overrides);
  return {separate::encoder::SeparateDevice(test::RunEncoderTwin(scenario).readings),
          sim::EncoderTwin(scenario).Truth()};
}

/// Mean of (error / u)^2 of a curve at every degree.
double MeanChi2(const separate::harmonics::HarmonicSeries& series, const nlohmann::json& truth) {
  const auto curve = separate::encoder::Curve(series, 360);
  double sum = 0.0;
  for (int i = 0; i < 360; ++i) {
    const double true_arcsec = truth.at("ez_arcsec").at(static_cast<std::size_t>(i)).get<double>();
    sum += std::pow((curve.value_rad[i] / arcsec - true_arcsec) * arcsec / curve.u_rad[i], 2) / 360.0;
  }
  return sum;
}

void ExpectTheAnswer(const Compared& run) {
  const auto& device = run.found.curves.device;
  EXPECT_NEAR(Amplitude(device.At(1)) / arcsec, 1800.0, 1.0);
  EXPECT_NEAR(Amplitude(device.At(2)) / arcsec, 1080.0, 1.0);
  EXPECT_NEAR(Amplitude(device.At(7)) / arcsec, 180.0, 1.0);
  EXPECT_NEAR(Amplitude(run.found.curves.reference.At(1)) / arcsec, 72.0, 1.0);
  for (const int order : run.found.curves.lost) EXPECT_EQ(order % 12, 0) << order;
  EXPECT_FALSE(run.found.curves.lost.empty());
  EXPECT_TRUE(run.found.curves.disagreeing.empty());
  // Means of the orders' chi-squared, 70 to 128 of them: standard deviation up to 0.17.
  EXPECT_NEAR(MeanChi2(device, run.truth.at("device")), 1.0, 0.5);
  EXPECT_NEAR(MeanChi2(run.found.curves.reference, run.truth.at("reference")), 1.0, 0.5);
}

TEST(EncoderMountings, TellTheEncodersErrorsFromTheRings) {
  const Compared run = Compare({});
  ExpectTheAnswer(run);
  EXPECT_EQ(run.found.highest_order, 35);
}

TEST(EncoderMountings, TellThemInContinuousMotionOverManyTurnsAtTwoSpeeds) {
  const Compared run =
      Compare({"encoder_procedure.kind=sweep", "encoder_procedure.turns=8", "encoder_procedure.passes=[1, -1]"});
  ExpectTheAnswer(run);
  EXPECT_EQ(run.found.highest_order, 64);
  EXPECT_EQ(run.found.passes.size(), 12u) << "3 mountings x 2 speeds x 2 directions";
  EXPECT_GT(run.found.left_out, 0) << "readings at rest behind each pass";
}

TEST(EncoderMountings, OneOfThemShowsOnlyTheDifference) {
  const Compared run = Compare({"encoder_procedure.mounting_deg=[0.0]"});
  const auto& first = run.found.curves.device.At(1).value;
  // Encoder - ring, both as they stand at 0 deg.
  const auto difference = std::polar(1800.0, 40.0 * units::deg) - std::polar(72.0, 75.0 * units::deg);
  // Noise 0.45 arcsec; the ring's error moves the encoder's curve by up to 72 arcsec x 0.02.
  EXPECT_NEAR(std::abs(first / arcsec - difference), 0.0, 2.0);
  EXPECT_TRUE(run.found.curves.reference.orders.empty());
}

/// What the mountings see alike of both is the device's, and is scored so.
TEST(EncoderMountings, AreScoredByTheDifferenceThatTheySee) {
  for (const char* mounting : {"encoder_procedure.mounting_deg=[35]", "encoder_procedure.mounting_deg=[20, 20]",
                               "encoder_procedure.mounting_deg=[0, 180]"}) {
    const Scenario scenario = LoadScenario(test::ScenarioPath("encoder_mountings.toml"), {mounting});
    const auto score = benches::encoder::ScoreRun(scenario, test::RunEncoderTwin(scenario).readings,
                                                  sim::EncoderTwin(scenario).Truth(), Estimator::kRigorous).json;
    EXPECT_NEAR(score.at("device").at("ez").at("mean_chi2").get<double>(), 1.0, 0.6) << mounting;
  }
}

}  // namespace
}  // namespace twinbench
