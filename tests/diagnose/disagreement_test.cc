#include "twin/diagnose/disagreement.h"

#include <gmock/gmock.h>

#include "tests/diagnose/ring_run.h"

namespace twinbench::diagnose {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

/// Readings with a direction of `size` that no unknown takes up, as found or not.
DiagnosisRun Off(double size_m, bool was_found) {
  DiagnosisRun found;
  found.run = test::MakeRing();
  test::AddRingNoise(found.run, 5);
  found.noise = test::WhiteNoise(found.run);
  Accepted direction = test::Direction(found.run);
  direction.amplitudes = Eigen::VectorXd::Constant(1, size_m);
  direction.family.amplitudes.front().prior_sd = size_m;
  // On both channels, that the middle of all rows shows it.
  for (int k = 0; k + 1 < found.run.Rows(); k += 2) direction.columns(k + 1, 0) = direction.columns(k, 0);
  found.run.residual += size_m * direction.columns;
  if (was_found) found.accepted = {direction};
  return found;
}

TEST(Disagreement, OfReadingsOfTheScenarioIsNotWorthALine) {
  const Disagreement disagreement = DisagreementOf(Off(1e-6, false));
  EXPECT_TRUE(disagreement.is_plausible);
  EXPECT_THAT(disagreement.line, IsEmpty());
}

TEST(Disagreement, ThatTheCausesExplainIsToldAndNoMore) {
  const Disagreement disagreement = DisagreementOf(Off(1e-3, true));
  EXPECT_TRUE(disagreement.is_plausible);
  EXPECT_THAT(disagreement.line, HasSubstr("times their noise"));
}

TEST(Disagreement, ThatNothingExplainsCannotBeTrusted) {
  const Disagreement disagreement = DisagreementOf(Off(1e-3, false));
  EXPECT_FALSE(disagreement.is_plausible);
  EXPECT_THAT(disagreement.line, HasSubstr("are they of this bench"));
}

}  // namespace
}  // namespace twinbench::diagnose
