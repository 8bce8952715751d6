#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/diagnose/encoder_fit.h"
#include "tests/diagnose/encoder_twin_run.h"
#include "twin/benches/encoder_comparison/bench.h"
#include "twin/benches/encoder_comparison/settings.h"
#include "twin/benches/names.h"

// Each named family against the twin's effect: two implementations that share no code.
namespace twinbench::diagnose::encoder {
namespace {

using test::EncoderEffect;
using test::EncoderScenario;
using units::deg;

struct Recovered {
  Family family;
  test::Fit fit;
  std::map<std::string, double> parameters;
};

/// Injects the effect into a noise-free run and fits the families of the same name, which know nothing of it; the
/// best.
Recovered Recover(const Scenario& scenario, const EffectSettings& effect) {
  const EncoderRun encoder = RunOf(test::ReadingsWith(scenario, effect), scenario);
  Recovered best;
  for (const Family& family : Families(encoder)) {
    if (family.effect != effect.name) continue;
    const test::Fit fit = test::BestFit(family, encoder.run);
    if (fit.left < best.fit.left) best = {family, fit, test::ParametersOf(family, fit)};
  }
  return best;
}

TEST(EncoderFamilies, RecoverErrorsThatRepeatWithTheAngle) {
  Scenario scenario = EncoderScenario("sweep");
  EncoderOf(scenario).device.lines = 20;
  EncoderOf(scenario).device.teeth = 44;
  std::map<std::string, double> injected = {{"amplitude", 1e-5}, {"phase", 0.7}};
  for (const char* name : {"eccentricity", "ellipticity", "periodic", "gear_mesh", "interpolation"}) {
    const EffectSettings effect = EncoderEffect(name, injected);
    const Recovered r = Recover(scenario, effect);
    EXPECT_LT(r.fit.left, 1e-4) << name;  // the columns take the angle without its error, 1e-5 * order
    EXPECT_NEAR(r.parameters.at("amplitude"), 1e-5, 1e-9) << name;
    EXPECT_NEAR(r.parameters.at("phase"), 0.7, 1e-3) << name;
    for (const char* order : {"order", "teeth"}) {
      const auto found = effect.parameters.find(order);
      if (found == effect.parameters.end()) continue;
      EXPECT_EQ(r.parameters.at(order), found->second) << name;
    }
  }
}

TEST(EncoderFamilies, ReportOfTheManyAmplitudesAndPhasesOfAWaveThePositiveOne) {
  const Scenario scenario = EncoderScenario();
  for (const double phase_rad : {-3.0, -0.3, 0.4, 2.9}) {
    const Recovered negative =
        Recover(scenario, EncoderEffect("eccentricity", {{"amplitude", -1e-5}, {"phase", phase_rad}}));
    EXPECT_NEAR(negative.parameters.at("amplitude"), 1e-5, 1e-9);
    EXPECT_NEAR(negative.parameters.at("phase"), phase_rad + units::kPi, 1e-3);
    const Recovered positive =
        Recover(scenario, EncoderEffect("periodic", {{"amplitude", 1e-5}, {"phase", phase_rad}}));
    EXPECT_NEAR(positive.parameters.at("amplitude"), 1e-5, 1e-9);
    EXPECT_NEAR(positive.parameters.at("phase"), phase_rad < 0.0 ? phase_rad + 2.0 * units::kPi : phase_rad, 1e-3);
  }
}

TEST(EncoderFamilies, TellAFaultyReferenceOnlyWhenTheDeviceWasTurned) {
  Scenario scenario = EncoderScenario();
  const auto fault = EncoderEffect("reference_fault", {{"order", 1.0}, {"amplitude", 1e-5}, {"phase", 0.4}});
  EXPECT_FALSE(test::HasFamily(Families(RunOf(test::ReadingsWith(scenario, fault), scenario)), "reference_fault"));
  EncoderOf(scenario).encoder_procedure.mounting_rad = {0.0, 90.0 * deg};
  const Recovered r = Recover(scenario, fault);
  EXPECT_LT(r.fit.left, 1e-4);
  EXPECT_NEAR(r.parameters.at("amplitude"), 1e-5, 1e-9);
  EXPECT_NEAR(r.parameters.at("phase"), 0.4, 1e-3);
  const EncoderRun encoder = RunOf(test::ReadingsWith(scenario, fault), scenario);
  // A quarter turn between the set-ups: an order 1 locked to the device explains half of the variance.
  EXPECT_NEAR(test::BestFit(test::FamilyOf(Families(encoder), "eccentricity"), encoder.run).left, std::sqrt(0.5),
              0.02);
}

TEST(EncoderFamilies, RecoverOffsetsOfTheSignals) {
  Scenario scenario = EncoderScenario();
  EncoderOf(scenario).device.signal_periods = 3;
  EncoderOf(scenario).device.signal_zero_rad = 0.3;
  const Recovered r =
      Recover(scenario, EncoderEffect("signal_offset", {{"offset_sin", 2e-5}, {"offset_cos", -1e-5}}));
  EXPECT_LT(r.fit.left, 1e-4);  // the square of the offsets is left
  EXPECT_NEAR(r.parameters.at("offset_sin"), 2e-5, 1e-8);
  EXPECT_NEAR(r.parameters.at("offset_cos"), -1e-5, 1e-8);
}

TEST(EncoderFamilies, RecoverMismatchAndQuadratureWhereTheZeroIsKnownAndWhereNot) {
  for (const bool known : {true, false}) {
    Scenario scenario = EncoderScenario();
    EncoderOf(scenario).device.signal_zero_rad = known ? 0.3 : 0.0;
    EncoderOf(scenario).device.signal_zero_known = known;
    const Recovered mismatch = Recover(scenario, EncoderEffect("amplitude_mismatch", {{"ratio", 2e-5}}));
    EXPECT_LT(mismatch.fit.left, 1e-3);
    EXPECT_NEAR(mismatch.parameters.at("ratio"), 2e-5, 1e-8);
    const Recovered quadrature = Recover(scenario, EncoderEffect("quadrature_error", {{"angle", 2e-5}}));
    EXPECT_LT(quadrature.fit.left, 1e-3);
    EXPECT_NEAR(quadrature.parameters.at("angle"), 2e-5, 1e-8);
  }
}

TEST(EncoderFamilies, KeepMismatchAndQuadratureApartWhereTheZeroIsKnown) {
  Scenario scenario = EncoderScenario();
  EncoderOf(scenario).device.signal_zero_known = true;
  const auto readings = test::ReadingsWith(scenario, EncoderEffect("amplitude_mismatch", {{"ratio", 2e-5}}));
  const EncoderRun encoder = RunOf(readings, scenario);
  EXPECT_GT(test::BestFit(test::FamilyOf(Families(encoder), "quadrature_error"), encoder.run).left, 0.99);
}

TEST(EncoderFamilies, RecoverClippingWithTheZeroFree) {
  const Scenario scenario = EncoderScenario("sweep");
  Scenario turned = scenario;  // what is diagnosed is not told of this
  EncoderOf(turned).device.signal_zero_rad = 33.75 * deg;
  const EncoderRun encoder =
      RunOf(test::ReadingsWith(turned, EncoderEffect("signal_clipping", {{"level", 0.90}})), scenario);
  const Family family = test::FamilyOf(Families(encoder), "signal_clipping");
  const test::Fit grid = test::BestFit(family, encoder.run);
  // The next levels of the grid differ by a factor 1.65 in depth; the strength takes up the size, not the shape.
  EXPECT_LT(grid.left, 0.15);
  EXPECT_NEAR(test::ParametersOf(family, grid).at("level"), 0.90, 0.04);
  Family exact = family;
  exact.columns = [&](int) { return family.at(Eigen::Vector2d(0.90, 33.75 * deg)); };
  const test::Fit fit = test::FitAt(exact, 0, encoder.run);
  EXPECT_LT(fit.left,
            0.02);  // the zero is taken from the mean offset of the run, which the clipping shifts a little
  EXPECT_NEAR(fit.amplitudes[0], 1.0, 0.02);
}

TEST(EncoderFamilies, RecoverLatencyOnlyInMotion) {
  const auto effect = EncoderEffect("latency", {{"delay", 1e-5}});
  const Recovered r = Recover(EncoderScenario("sweep"), effect);
  // In the ramps the speed changes by up to 1e-5 of itself meanwhile.
  EXPECT_LT(r.fit.left, 1e-5);
  EXPECT_NEAR(r.parameters.at("delay"), 1e-5, 1e-12);
  const Scenario stops = EncoderScenario("stops");
  EXPECT_FALSE(test::HasFamily(Families(RunOf(test::ReadingsWith(stops, effect), stops)), "latency"));
}

TEST(EncoderFamilies, RecoverBacklashToFirstOrder) {
  const auto effect = EncoderEffect("backlash", {{"width", 1e-5}});
  const Recovered stops = Recover(EncoderScenario("stops"), effect);
  EXPECT_LT(stops.fit.left, 1e-9);
  EXPECT_NEAR(stops.parameters.at("width"), 1e-5, 1e-13);
  const Recovered sweep = Recover(EncoderScenario("sweep"), effect);
  EXPECT_LT(sweep.fit.left, 0.05);  // at each reversal one reading stands where the gap is not yet crossed
  EXPECT_NEAR(sweep.parameters.at("width"), 1e-5, 1e-7);
}

TEST(EncoderFamilies, RecoverBacklashOfStopsThatWereTakenWithoutRunUp) {
  const Scenario scenario = EncoderScenario("stops");
  auto readings = twinbench::test::RunEncoderTwin(scenario).readings;
  for (std::size_t i = 0; i < readings.size(); ++i) {
    const double way_rad = i == 0 ? 1.0 : readings[i].reference_rad - readings[i - 1].reference_rad;
    const bool turning = way_rad == 0.0;  // the gap is still open to the side of the pass before
    const int sense = turning ? -readings[i].direction : way_rad > 0.0 ? 1 : -1;
    readings[i].measured_rad -= 0.5e-5 * sense;
  }
  const EncoderRun encoder = RunOf(readings, scenario);
  const Family family = test::FamilyOf(Families(encoder), "backlash");
  const test::Fit fit = test::BestFit(family, encoder.run);
  EXPECT_LT(fit.left, 1e-9);
  EXPECT_NEAR(test::ParametersOf(family, fit).at("width"), 1e-5, 1e-13);
}

TEST(EncoderFamilies, RecoverHysteresisAtTheNextSettlingLength) {
  for (const char* kind : {"stops", "sweep"}) {
    const auto effect = EncoderEffect("hysteresis", {{"lag", 1e-5}, {"settles_over", 30.0 * deg}});
    const Recovered r = Recover(EncoderScenario(kind), effect);
    EXPECT_LT(r.fit.left, 0.05) << kind;  // settling lengths of the grid differ by a factor 1.37
    EXPECT_NEAR(r.parameters.at("lag"), 1e-5, 3e-7) << kind;
    EXPECT_NEAR(r.parameters.at("settles_over") / (30.0 * deg), 1.0, 0.2) << kind;
    EXPECT_NEAR(r.parameters.at("start"), 0.0, 1e-12) << kind;
  }
}

TEST(EncoderFamilies, RecoverScaleDriftAndSlip) {
  const Scenario scenario = EncoderScenario();
  const Recovered scale = Recover(scenario, EncoderEffect("scale", {{"ratio", 1e-6}}));
  EXPECT_LT(scale.fit.left, 1e-6);
  EXPECT_NEAR(scale.parameters.at("ratio"), 1e-6, 1e-12);
  const Recovered drift = Recover(scenario, EncoderEffect("drift", {{"rate", 1e-8}, {"curvature", -0.4}}));
  EXPECT_LT(drift.fit.left, 1e-6);
  EXPECT_NEAR(drift.parameters.at("rate"), 1e-8, 1e-13);
  EXPECT_NEAR(drift.parameters.at("curvature"), -0.4, 1e-5);
  const Recovered slip = Recover(scenario, EncoderEffect("slip", {{"step", 1e-5}, {"at_reading", 333.0}}));
  EXPECT_LT(slip.fit.left, 1e-6);
  EXPECT_NEAR(slip.parameters.at("step"), 1e-5, 1e-11);
  EXPECT_EQ(slip.parameters.at("at_reading"), 333.0);
}

TEST(EncoderFamilies, GiveCausesOfOneOrderTheSameColumnsAndPriors) {
  const Scenario scenario = EncoderScenario();
  const auto families = Families(RunOf(twinbench::test::RunEncoderTwin(scenario).readings, scenario));
  const auto scaled = [&](const char* name) {
    const Family& family = test::FamilyOf(families, name);
    Eigen::MatrixXd columns = family.ColumnsAt(0);
    for (Eigen::Index j = 0; j < columns.cols(); ++j) columns.col(j) *= family.amplitudes[j].prior_sd;
    return Eigen::MatrixXd(columns * columns.transpose());  // the prior covariance of the signal
  };
  const auto expect_same = [&](const char* a, const char* b) {
    EXPECT_LT((scaled(a) - scaled(b)).norm(), 1e-9 * scaled(a).norm()) << a << " " << b;
  };
  expect_same("eccentricity", "signal_offset");
  expect_same("ellipticity", "amplitude_mismatch");
  expect_same("ellipticity", "quadrature_error");
}

TEST(EncoderNextMeasurement, SplitsWhatOneRunCannot) {
  EXPECT_THAT(benches::encoder::NextMeasurement("signal_offset", "eccentricity"),
              testing::HasSubstr("raw sine and cosine"));
  EXPECT_THAT(benches::encoder::NextMeasurement("hysteresis", "backlash"), testing::HasSubstr("behind a reversal"));
  EXPECT_THAT(benches::encoder::NextMeasurement("backlash", "latency"), testing::HasSubstr("speed"));
  EXPECT_THAT(benches::encoder::NextMeasurement("eccentricity", "reference_fault"),
              testing::HasSubstr("turned on the shaft"));
  for (const EffectEntry& a : EffectCatalogue(kEncoderBench)) {
    for (const EffectEntry& b : EffectCatalogue(kEncoderBench)) {
      EXPECT_FALSE(benches::encoder::NextMeasurement(a.name, b.name).empty());
      EXPECT_EQ(benches::encoder::NextMeasurement(a.name, b.name),
                benches::encoder::NextMeasurement(b.name, a.name));
    }
  }
}

TEST(EncoderFamilies, HaveUniqueGroupsByEffectAndBoundsOfTheCatalogue) {
  Scenario scenario = EncoderScenario("sweep");
  EncoderOf(scenario).device.lines = 20;
  EncoderOf(scenario).device.teeth = 44;
  for (const Family& family : Families(RunOf(twinbench::test::RunEncoderTwin(scenario).readings, scenario))) {
    if (family.kind != Kind::kNamed) continue;
    EXPECT_EQ(family.group, family.effect);
    EXPECT_NE(FindEffect(family.effect, kEncoderBench), nullptr) << family.effect;
    for (const Amplitude& a : family.amplitudes) EXPECT_GT(a.prior_sd, 0.0) << family.effect;
    for (const Shape& s : family.shapes) EXPECT_EQ(std::ssize(s.value), family.grid) << family.effect;
  }
}

TEST(EncoderFamilies, LetHysteresisBeginWithNoMoreThanItsLag) {
  const Scenario scenario = EncoderScenario();
  const auto families = Families(RunOf(twinbench::test::RunEncoderTwin(scenario).readings, scenario));
  const Family& family = test::FamilyOf(families, "hysteresis");
  ASSERT_EQ(family.amplitudes.size(), 1u) << "a decay from the start without a lag is no hysteresis";
  EXPECT_EQ(family.shapes[1].lower, -1.0);
  EXPECT_EQ(family.shapes[1].upper, 1.0);
}

TEST(EncoderFamilies, RecoverPlayThatIsCrossedOverManyReadings) {
  Scenario scenario = EncoderScenario("sweep");
  EncoderOf(scenario).encoder_procedure.passes = {1, -1, 1, -1};
  const double width_rad = 25.0 * deg;
  const auto effect = EncoderEffect("backlash", {{"width", width_rad}, {"start", 0.4}});
  const EncoderRun encoder = RunOf(test::ReadingsWith(scenario, effect), scenario);
  const std::vector<Family> families = Families(encoder);
  // The other family of the name is that of gaps that are crossed at once.
  const auto crossed = std::ranges::find_if(
      families, [](const Family& f) { return f.effect == "backlash" && f.shapes.front().name == "crossed_over"; });
  ASSERT_NE(crossed, families.end());
  Family exact = *crossed;
  EXPECT_LT(test::BestFit(exact, encoder.run).left, 0.2);  // ways of the grid differ by a factor 1.3
  exact.columns = [at = exact.at, width_rad](int) { return at(Eigen::Vector3d(width_rad, 0.4, 1.0)); };
  const test::Fit fit = test::FitAt(exact, 0, encoder.run);
  EXPECT_LT(fit.left, 1e-9);
  EXPECT_NEAR(fit.amplitudes[0], width_rad, 1e-9);
}

TEST(EncoderFamilies, RecoverAWarmUpAsADriftThatSettles) {
  const Scenario scenario = EncoderScenario("stops");
  const Recovered r = Recover(scenario, EncoderEffect("drift", {{"rate", 1e-8}, {"warm_up", 300.0}}));
  EXPECT_LT(r.fit.left, 0.08);  // times of the grid differ by a factor 1.36
  EXPECT_NEAR(r.parameters.at("warm_up"), 300.0, 60.0);
}

TEST(EncoderFamilies, StateUncertaintiesOfShapesWhereTheCovarianceHasThem) {
  const Scenario scenario = EncoderScenario();
  const auto families = Families(RunOf(twinbench::test::RunEncoderTwin(scenario).readings, scenario));
  const Eigen::Vector4d sd(1e-6, 0.2, 0.1, 0.3);  // lag, settles_over, start, approach
  const Eigen::MatrixXd cov = sd.array().square().matrix().asDiagonal();
  const Family& family = test::FamilyOf(families, "hysteresis");
  const Eigen::Vector3d shape(0.5, 0.04, 1.0);
  const Eigen::VectorXd x = Eigen::VectorXd::Constant(1, 1e-4);
  EXPECT_NEAR(family.parameters(shape, x, cov)[1].u, 0.2, 1e-12);
  EXPECT_TRUE(std::isnan(family.parameters(shape, x, cov.topLeftCorner<1, 1>())[1].u)) << "held fixed";
  const Family& clipping = test::FamilyOf(families, "signal_clipping");
  const Eigen::Vector3d sd_clipping(0.1, 2e-4, 0.01);  // strength, level, zero
  const Eigen::MatrixXd cov_clipping = sd_clipping.array().square().matrix().asDiagonal();
  EXPECT_NEAR(clipping.parameters(Eigen::Vector2d(0.98, 0.0), Eigen::VectorXd::Ones(1), cov_clipping)[0].u, 2e-4,
              1e-12);
}

TEST(EncoderFamilies, StateUncertaintiesThatFollowFromTheCovariance) {
  const Scenario scenario = EncoderScenario();
  const auto families = Families(RunOf(twinbench::test::RunEncoderTwin(scenario).readings, scenario));
  const Family& family = test::FamilyOf(families, "eccentricity");
  const Eigen::Vector2d x(3e-4, 4e-4);
  const Eigen::Matrix2d cov = Eigen::Vector2d(1e-12, 4e-12).asDiagonal();
  const auto parameters = family.parameters({}, x, cov);
  EXPECT_NEAR(parameters[0].value, 5e-4, 1e-15);
  // Along (0.6, 0.8): 0.36 * 1 + 0.64 * 4 = 2.92; across (-0.8, 0.6): 0.64 * 1 + 0.36 * 4 = 2.08, over the size.
  EXPECT_NEAR(parameters[0].u, std::sqrt(2.92e-12), 1e-15);
  EXPECT_NEAR(parameters[1].u, std::sqrt(2.08e-12) / 5e-4, 1e-12);
}

}  // namespace
}  // namespace twinbench::diagnose::encoder
