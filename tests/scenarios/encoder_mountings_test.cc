#include "tests/scenarios/as_shipped.h"
#include "twin/benches/encoder_comparison/bench.h"
#include "twin/benches/encoder_comparison/estimators/device_error.h"
#include "twin/diagnose/diagnose.h"

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

// The answer that scenarios/encoder_heads.toml promises.

/// A shipped scenario of the encoders carried out; results and score are evaluations of their own, each made by whoever asks.
struct EncoderScenarioRun {
  Scenario scenario;
  Estimator estimator;
  std::vector<Reading> readings;

  nlohmann::json Results() const { return benches::encoder::Evaluate(scenario, readings, estimator).results; }
  nlohmann::json Score() const {
    return benches::encoder::ScoreRun(scenario, readings, sim::EncoderTwin(scenario).Truth(), estimator).json;
  }
};

EncoderScenarioRun RunEncoderScenario(const std::string& file, const std::vector<std::string>& overrides,
                                             Estimator estimator = Estimator::kRigorous) {
  const Scenario scenario = LoadScenario(test::ScenarioPath(file), overrides);
  return {scenario, estimator, overrides.empty() ? test::AsShipped(file).readings : test::RunEncoderTwin(scenario).readings};
}

/// By the path of a JSON pointer.
double Figure(const nlohmann::json& json, const char* path) {
  return json.at(nlohmann::json::json_pointer(path)).get<double>();
}

EncoderScenarioRun HeadsRun(const std::vector<std::string>& overrides, Estimator estimator = Estimator::kRigorous) {
  return RunEncoderScenario("encoder_heads.toml", overrides, estimator);
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

// The answer that scenarios/encoder_coast.toml promises.

EncoderScenarioRun Coasted(const std::vector<std::string>& overrides, Estimator estimator = Estimator::kRigorous) {
  return RunEncoderScenario("encoder_coast.toml", overrides, estimator);
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

/// By the angles of its lines the curve was 13 arcsec wrong, with u = 0.003.
TEST(EncoderCoast, HasTheErrorsOfALargeRingWhereItsLinesAre) {
  EXPECT_LT(Chi2(Coasted({"device.graduation_arcsec=360", "encoder_procedure.turns=5"})), 8.0);
}

TEST(EncoderCoast, RefusesASpindleThatWouldStandStill) {
  EXPECT_THROW(Coasted({"spindle.viscous_per_s=0.5"}), InputError);
  EXPECT_THROW(Coasted({"encoder_procedure.heads_deg=[0, 90]"}), InputError);
}

/// Readings in a row are of another head each.
TEST(EncoderHeads, AreDiagnosedWhereAllOfThemStayBehindOnReversal) {
  const Scenario made = LoadScenario(test::ScenarioPath("encoder_heads.toml"),
                                     {"encoder_procedure.heads_deg=[0, 72, 144, 216, 288]", "encoder_procedure.stops_per_turn=72",
                                      "effect=[{name=\"backlash\", width_deg=0.003}]"});
  Scenario believed = made;
  believed.effects.clear();
  const diagnose::DiagnosisRun found = diagnose::Diagnose(test::RunEncoderTwin(made).readings, believed, {});
  const std::vector<diagnose::Cause>& causes = found.diagnosis.causes;
  EXPECT_NE(std::ranges::find(causes, "backlash", &diagnose::Cause::effect), causes.end());
  for (const char* against_targets : {"scale", "reference_fault"})
    EXPECT_EQ(std::ranges::find(causes, against_targets, &diagnose::Cause::effect), causes.end()) << against_targets;
}

}  // namespace
}  // namespace twinbench
