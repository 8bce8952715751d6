#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/angle_benches.h"
#include "tests/support/thresholds.h"
#include "tests/support/twin_run.h"
#include "twin/benches/registry.h"
#include "twin/benches/rotary_4dof/bench.h"
#include "twin/benches/rotary_4dof/diagnose.h"
#include "twin/core/signal_effect.h"
#include "twin/diagnose/engine/scanner.h"
#include "twin/diagnose/extend.h"

/// Structure that no cause of the catalogue has, found in one run: what is written of it predicts another.
namespace twinbench::diagnose {
namespace {

using units::arcsec, units::um;

struct Case {
  std::string scenario;  // file
  EffectSettings signal;
};

EffectSettings Signal(const std::string& point, const std::string& kind, const std::string& by,
                      const std::string& times, std::map<std::string, double> parameters) {
  return {kSignalEffect, point, std::move(parameters), "", {}, kind, by, times};
}

Scenario With(Scenario scenario, const EffectSettings& signal) {
  scenario.effects.push_back(signal);
  return scenario;
}

/// What the free unknowns of a run leave of its readings, in units of noise.
double LeftOf(const std::vector<Reading>& readings, const Scenario& believed) {
  return FreeMisfit(BenchOf(believed).linear_run(readings, believed, Estimator::kRigorous)).power;
}

/// Fewer simulated runs than a user's: nothing here is near the threshold.
DiagnosisRun FoundIn(const std::vector<Reading>& readings, const Scenario& believed) {
  return Diagnose(readings, believed, twinbench::test::QuickOptions(100));
}

class AnotherSeed : public testing::TestWithParam<Case> {};

TEST_P(AnotherSeed, IsPredictedByWhatWasFound) {
  Scenario stated = LoadScenario(twinbench::test::ScenarioPath(GetParam().scenario));
  stated.environment.swing_K = 0.5;
  Scenario actual = With(stated, GetParam().signal);
  actual.seed = 11;
  const DiagnosisRun found = FoundIn(twinbench::test::ReadingsOf(actual), stated);
  ASSERT_EQ(found.diagnosis.verdict, Verdict::kUnknown) << found.diagnosis.unknown.signature;
  const Scenario extended = Extend(stated, found, "test");
  ASSERT_TRUE(extended.empiricals.empty()) << found.diagnosis.unknown.signature;
  actual.seed = 12;
  const std::vector<Reading> another = twinbench::test::ReadingsOf(actual);
  const double before = LeftOf(another, stated), with_truth = LeftOf(another, With(stated, GetParam().signal));
  const double removed = (before - LeftOf(another, extended)) / (before - with_truth);
  EXPECT_GT(removed, 0.9) << found.diagnosis.unknown.signature;
  EXPECT_EQ(FoundIn(another, extended).diagnosis.verdict, Verdict::kNone);
}

std::vector<Case> Cases() {
  return {{"rotary_4dof.toml", Signal("psd_b_y", "harmonic", "target", "direction",
                                      {{"order", 3}, {"amplitude", 1.5 * um}, {"phase", 0.7}})},
          {"rotary_4dof.toml",
           Signal("psd_b_x", "fringes", "", "", {{"period", 60 * um}, {"amplitude", 1.5 * um}, {"phase", 0.0}})},
          {"rotary_4dof.toml",
           Signal("psd_a_x", "share", "psd_a_x", "temperature", {{"share", 0.03}, {"about", 0.0}, {"per", 1.0}})},
          {"rotary_4dof.toml", Signal("psd_a_y", "interaction", "", "",
                                      {{"order", 2}, {"with_order", -3}, {"amplitude", 2 * um}, {"phase", 0.0}})},
          {"encoder_comparison.toml", Signal("angle", "harmonic", "device", "",
                                             {{"order", 4.53}, {"amplitude", 40 * arcsec}, {"phase", 0.0}})},
          {"turntable_autocollimator.toml", Signal("y", "harmonic", "turntable", "direction",
                                                   {{"order", 3}, {"amplitude", 0.8 * arcsec}, {"phase", 0.0}})},
          {"hob_transmission.toml",
           Signal("transmission", "harmonic", "table", "time",
                  {{"order", 5}, {"amplitude", 3 * arcsec}, {"phase", 0.0}, {"about", 0.0}, {"per", 600.0}})}};
}

std::string NameOf(const testing::TestParamInfo<Case>& info) {
  return std::to_string(info.index) + "_" + info.param.signal.signal;
}

INSTANTIATE_TEST_SUITE_P(AllBenches, AnotherSeed, testing::ValuesIn(Cases()), NameOf);

/// What is left of the readings pulls at a free unknown as its prior, a tenth as wide in the fit, pulls back, in units of
/// that unknown's own uncertainty: the normal equations hold.
TEST(RotaryRun, PredictsWhatTheFreeUnknownsFitBest) {
  const Scenario scenario = LoadScenario(twinbench::test::ScenarioPath("rotary_4dof.toml"));
  const LinearRun run =
      benches::rotary::Linear(twinbench::test::RunTwin(scenario).readings, scenario, Estimator::kRigorous);
  const Eigen::VectorXd weight = run.sigma.cwiseInverse();
  const Eigen::SparseMatrix<double> white = weight.asDiagonal() * run.nuisance.jacobian;
  const Eigen::VectorXd pull = white.transpose() * weight.cwiseProduct(run.observed - run.Predicted());
  const Eigen::VectorXd held = 100.0 * run.nuisance.prior_precision.cwiseProduct(run.nuisance.at);
  const Eigen::Index known = std::ssize(benches::rotary::CalibratedConstants());
  for (Eigen::Index k = 0; k < pull.size() - known; ++k) {
    const double length = white.col(k).norm();
    // The twin is no straight line: by some 1e-3 of an uncertainty behind the last step.
    EXPECT_LT(std::abs(pull[k] - held[k]), 1e-2 * std::max(length, 1.0)) << "unknown " << k;
  }
}

/// One degree: the tangent at zero is off by a fifth of what the free unknowns leave of the effect.
constexpr double kIncidence_rad = 17e-3;

TEST(RotarySearch, NamesAChangeOfTheBenchThatIsLargeEnoughToBend) {
  const Scenario believed = LoadScenario(twinbench::test::ScenarioPath("rotary_4dof.toml"));
  Scenario actual = believed;
  actual.effects.push_back({"incidence_offset", "", {{"incidence", kIncidence_rad}}, ""});
  const Diagnosis found = FoundIn(twinbench::test::RunTwin(actual).readings, believed).diagnosis;
  ASSERT_EQ(found.causes.size(), 1U);
  EXPECT_EQ(found.causes[0].effect, "incidence_offset");
  const ParameterEstimate& incidence = found.causes[0].parameters.at(0);
  EXPECT_NEAR(incidence.value, kIncidence_rad, 4.0 * incidence.u);
  EXPECT_LT(incidence.u, 0.1 * kIncidence_rad);
}

}  // namespace
}  // namespace twinbench::diagnose
