#include "tests/diagnose/found_causes.h"
#include "tests/diagnose/ring_run.h"
#include "tests/support/angle_benches.h"
#include "tests/support/small_scenario.h"
#include "tests/support/thresholds.h"
#include "twin/benches/names.h"
#include "twin/benches/rotary_4dof/bench.h"
#include "twin/benches/rotary_4dof/diagnose.h"
#include "twin/core/errors.h"
#include "twin/core/signal_effect.h"
#include "twin/diagnose/engine/followed.h"
#include "twin/diagnose/engine/scanner.h"
#include "twin/diagnose/extend.h"
#include "twin/diagnose/file_fit.h"
#include "twin/diagnose/words.h"
#include "twin/diagnose/written_file.h"

namespace twinbench::diagnose {
namespace {

using testing::Contains, testing::HasSubstr, testing::IsEmpty;

/// Noise, and a direction found and named as a gain of a PSD.
DiagnosisRun FoundDirection(std::uint64_t seed, double size_m) {
  DiagnosisRun found = test::NamedRun(test::FoundPsdGain(0.003));
  found.run = test::MakeRing();
  test::AddRingNoise(found.run, seed);
  found.noise = test::WhiteNoise(found.run);
  found.accepted = {test::Direction(found.run)};
  Accepted& accepted = found.accepted.front();
  accepted.family.effect = "psd_gain";
  accepted.family.where = "psd_a_x";
  accepted.amplitudes = Eigen::VectorXd::Constant(1, size_m);
  return found;
}

/// The same with 1 um of it in the readings.
DiagnosisRun FoundAsRead() {
  DiagnosisRun found = FoundDirection(3, 1e-6);
  test::AddUnknowns(found.run, 3);
  found.run.residual += found.accepted.front().columns * found.accepted.front().amplitudes;
  return found;
}

/// A bench whose written file shows so much of the direction.
AgainstScenario Showing(const DiagnosisRun& found, double share) {
  return [&found, share](const std::vector<Reading>&, const Scenario& scenario, Estimator) {
    LinearRun left = found.run;
    if (scenario.effects.empty()) return left;
    left.residual -= share * found.accepted.front().columns * found.accepted.front().amplitudes;
    return left;
  };
}

Diagnosis Judged(DiagnosisRun found, const AgainstScenario& against) {
  JudgeByFile({}, twinbench::test::SmallNoiseFree(), {}, against, found);
  return found.diagnosis;
}

using Notes = testing::Matcher<std::vector<std::string>>;

TEST(JudgeByFile, AFileThatShowsAllOrHalfGainsAllOrThreeQuartersAndOneThatShowsNothingMakesTheCauseAProposal) {
  const DiagnosisRun found = FoundAsRead();
  const double stated = found.diagnosis.causes.front().probability;
  for (const auto& [share, gain, notes] :
       {std::tuple(1.0, 1.0, Notes(IsEmpty())),
        {0.5, 0.75, Notes(Contains(HasSubstr("shows 75 % of what was found")))},
        {0.0, 0.0, Notes(Contains(kNoGainNote))}}) {
    SCOPED_TRACE(share);
    const Diagnosis d = Judged(found, Showing(found, share));
    EXPECT_NEAR(d.gain.fraction_removed, gain, 0.05);
    EXPECT_EQ(d.gain.positive, share > 0.0);
    EXPECT_THAT(d.notes, notes);
    EXPECT_LE(d.causes.front().probability, share > 0.0 ? stated : 0.6);
    EXPECT_GE(d.causes.front().probability, share > 0.0 ? stated : 0.0);
  }
}

TEST(Followed, WhatNoBodyCanBeIsTheFaultOfItsScenario) {
  const model::FollowMaker maker = [](const auto&, const auto&) -> std::unique_ptr<model::Follow> { throw std::invalid_argument("a ring of no radius"); };
  EXPECT_THROW(Followed(maker, twinbench::test::SmallNoiseFree(), {}, {}, 0), InputError);
}

TEST(JudgeByFile, AFileThatTheBenchRefusesIsToldAndTheFitIsJudged) {
  const DiagnosisRun found = FoundAsRead();
  const Diagnosis d = Judged(found, [&found](const auto&, const Scenario& scenario, Estimator) {
    if (scenario.effects.empty()) return found.run;
    throw InputError("extended.toml:7", "this cannot be built", "something else");
  });
  EXPECT_NEAR(d.gain.fraction_removed, 1.0, 0.05);
  EXPECT_THAT(d.notes, Contains(HasSubstr("that of the fit")));
  EXPECT_THAT(d.notes, Contains(HasSubstr("this cannot be built")));
}

/// A cause whose twin shows more the larger it is, as signals do: x + x^2 / 2, of x in um.
Eigen::VectorXd ShownByTwin(const Accepted& direction, double size_m) {
  const double x = size_m / 1e-6;
  return 1e-6 * (x + 0.5 * x * x) * direction.columns.col(0);
}

struct Bent {
  DiagnosisRun found;
  Accepted direction;
};

/// Readings with that cause in a size of 1.5 um, found to first order.
Bent FoundToFirstOrder() {
  Bent bent;
  bent.found = FoundDirection(11, (1.5 + 0.5 * 1.5 * 1.5) * 1e-6);
  bent.direction = test::Direction(bent.found.run);
  bent.found.run.residual += ShownByTwin(bent.direction, 1.5e-6);
  Accepted& accepted = bent.found.accepted.front();
  accepted.family.amplitudes.front().name = "gain_error";
  accepted.family.amplitudes.front().prior_sd = 1e-5;
  bent.found.diagnosis.causes.front().parameters.front().value = accepted.amplitudes[0];
  return bent;
}

TEST(FitThroughFile, MovesASizeToWhereTheTwinShowsWhatWasRead) {
  Bent bent = FoundToFirstOrder();
  const RemovedBy removed_by = [&](const DiagnosisRun& found) {
    return ShownByTwin(bent.direction, found.diagnosis.causes.front().parameters.front().value);
  };
  Eigen::VectorXd removed = removed_by(bent.found);
  const double before = PowerLeft(bent.found, removed);
  FitThroughFile(removed_by, bent.found, removed);
  EXPECT_NEAR(bent.found.diagnosis.causes.front().parameters.front().value, 1.5e-6, 0.1e-6);
  EXPECT_LT(PowerLeft(bent.found, removed), 0.1 * before);
}

TEST(FitThroughFile, LeavesOutWhatIsNothingBesideTheTwin) {
  Bent bent = FoundToFirstOrder();
  // On the other channel nothing is left, but something was found to first order.
  Accepted ghost = bent.found.accepted.front();
  ghost.family.effect = "psd_offset";
  ghost.columns = Eigen::MatrixXd::Zero(bent.found.run.Rows(), 1);
  for (int k = 0; k + 1 < bent.found.run.Rows(); k += 2) ghost.columns(k + 1, 0) = bent.direction.columns(k, 0);
  ghost.amplitudes[0] = 0.3e-6;
  Cause cause = bent.found.diagnosis.causes.front();
  cause.effect = "psd_offset";
  cause.parameters.front().value = ghost.amplitudes[0];
  cause.parameters.front().u = 0.06e-6;
  bent.found.accepted.push_back(ghost);
  bent.found.diagnosis.causes.push_back(cause);
  const RemovedBy removed_by = [&](const DiagnosisRun& found) {
    const std::vector<Cause>& causes = found.diagnosis.causes;
    Eigen::VectorXd removed = ShownByTwin(bent.direction, causes.front().parameters.front().value);
    if (causes.size() > 1) removed += causes[1].parameters.front().value * ghost.columns.col(0);
    return removed;
  };
  Eigen::VectorXd removed = removed_by(bent.found);
  FitThroughFile(removed_by, bent.found, removed);
  ASSERT_EQ(bent.found.diagnosis.causes.size(), 1u);
  EXPECT_EQ(bent.found.diagnosis.causes.front().effect, "psd_gain");
  EXPECT_EQ(bent.found.accepted.size(), 1u);
}

/// Structure that no cause of the catalogue has, found in one run: what is written of it predicts another.

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

TEST(RotarySearch, NamesEveryWireThatMayBeExchanged) {
  const Scenario believed =
      LoadScenario(twinbench::test::ScenarioPath("rotary_4dof.toml"),
                   {"procedure.positions=12", "procedure.shifts=[0, 1, 5]", "mechanics.fidelity=kinematic"});
  for (const std::string& where : FindEffect("convention", kRotaryBench)->places) {
    if (where.starts_with("reverse_") || where == "index_offset") continue;  // labels of tables, which no reading shows
    Scenario actual = believed;
    actual.effects.push_back({"convention", where, {}, ""});
    const std::vector<Cause> causes = FoundIn(twinbench::test::RunTwin(actual).readings, believed).diagnosis.causes;
    ASSERT_EQ(causes.size(), 1U) << where;
    EXPECT_EQ(causes[0].where, where);
  }
}

}  // namespace
}  // namespace twinbench::diagnose
