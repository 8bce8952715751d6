#include "twin/diagnose/file_fit.h"

#include <gtest/gtest.h>

#include "tests/diagnose/found_causes.h"
#include "tests/diagnose/ring_run.h"

namespace twinbench::diagnose {
namespace {

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
  bent.found = test::NamedRun(test::FoundPsdGain(0.0));
  bent.found.run = test::MakeRing();
  test::AddRingNoise(bent.found.run, 11);
  bent.found.noise = test::WhiteNoise(bent.found.run);
  bent.direction = test::Direction(bent.found.run);
  bent.found.run.residual += ShownByTwin(bent.direction, 1.5e-6);
  Accepted accepted = bent.direction;
  accepted.family.effect = "psd_gain";
  accepted.family.where = "psd_a_x";
  accepted.family.amplitudes.front().name = "gain_error";
  accepted.family.amplitudes.front().prior_sd = 1e-5;
  accepted.amplitudes = Eigen::VectorXd::Constant(1, (1.5 + 0.5 * 1.5 * 1.5) * 1e-6);
  bent.found.diagnosis.causes.front().parameters.front().value = accepted.amplitudes[0];
  bent.found.accepted = {accepted};
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
