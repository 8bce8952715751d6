#include "twin/diagnose/written_file.h"

#include <gmock/gmock.h>

#include "tests/diagnose/found_causes.h"
#include "tests/diagnose/ring_run.h"
#include "tests/support/small_scenario.h"
#include "twin/core/errors.h"
#include "twin/diagnose/file_fit.h"
#include "twin/diagnose/words.h"

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

TEST(JudgeByFile, AFileThatShowsAllGainsAll) {
  const DiagnosisRun found = FoundAsRead();
  const Diagnosis d = Judged(found, Showing(found, 1.0));
  EXPECT_NEAR(d.gain.fraction_removed, 1.0, 0.05);
  EXPECT_THAT(d.notes, IsEmpty());
}

TEST(JudgeByFile, AFileThatShowsHalfGainsThreeQuartersAndSaysSo) {
  const DiagnosisRun found = FoundAsRead();
  const Diagnosis d = Judged(found, Showing(found, 0.5));
  EXPECT_NEAR(d.gain.fraction_removed, 0.75, 0.05);
  EXPECT_THAT(d.notes, Contains(HasSubstr("shows 75 % of what was found")));
  EXPECT_EQ(d.causes.front().probability, found.diagnosis.causes.front().probability);
}

TEST(JudgeByFile, AFileThatShowsNothingMakesTheCauseAProposal) {
  const DiagnosisRun found = FoundAsRead();
  const Diagnosis d = Judged(found, Showing(found, 0.0));
  EXPECT_FALSE(d.gain.positive);
  EXPECT_THAT(d.notes, Contains(kNoGainNote));
  EXPECT_LE(d.causes.front().probability, 0.6);
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

}  // namespace
}  // namespace twinbench::diagnose
