#include "twin/diagnose/written_file.h"

#include <gmock/gmock.h>

#include "tests/diagnose/found_causes.h"
#include "tests/diagnose/ring_run.h"
#include "tests/support/small_scenario.h"
#include "twin/core/errors.h"
#include "twin/diagnose/words.h"

namespace twinbench::diagnose {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

/// A direction of 1 um in the readings, found and named as a gain of a PSD.
DiagnosisRun FoundDirection() {
  DiagnosisRun found = test::NamedRun(test::FoundPsdGain(0.003));
  found.run = test::MakeRing();
  test::AddUnknowns(found.run, 3);
  test::AddRingNoise(found.run, 3);
  Accepted accepted = test::Direction(found.run);
  accepted.family.effect = "psd_gain";
  accepted.family.where = "psd_a_x";
  accepted.amplitudes = Eigen::VectorXd::Constant(1, 1e-6);
  found.run.residual += accepted.columns * accepted.amplitudes;
  found.noise = test::WhiteNoise(found.run);
  found.accepted = {accepted};
  return found;
}

/// A bench whose written file shows so much of the direction.
AgainstScenario Showing(const DiagnosisRun& found, double share, std::vector<std::string>* effects = nullptr) {
  return [&found, share, effects](const std::vector<Reading>&, const Scenario& scenario, Estimator) {
    if (effects) {
      for (const EffectSettings& effect : scenario.effects) effects->push_back(effect.name);
    }
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

TEST(JudgeByFile, ReadsTheWrittenScenarioBack) {
  const DiagnosisRun found = FoundDirection();
  std::vector<std::string> effects;
  Judged(found, Showing(found, 1.0, &effects));
  EXPECT_THAT(effects, testing::ElementsAre("psd_gain"));
}

TEST(JudgeByFile, AFileThatShowsAllGainsAll) {
  const DiagnosisRun found = FoundDirection();
  const Diagnosis d = Judged(found, Showing(found, 1.0));
  EXPECT_NEAR(d.gain.fraction_removed, 1.0, 0.05);
  EXPECT_THAT(d.notes, IsEmpty());
}

TEST(JudgeByFile, AFileThatShowsHalfGainsThreeQuartersAndSaysSo) {
  const DiagnosisRun found = FoundDirection();
  const Diagnosis d = Judged(found, Showing(found, 0.5));
  EXPECT_NEAR(d.gain.fraction_removed, 0.75, 0.05);
  EXPECT_THAT(d.notes, Contains(HasSubstr("shows 75 % of what was found")));
  EXPECT_EQ(d.causes.front().probability, found.diagnosis.causes.front().probability);
}

TEST(JudgeByFile, AFileThatShowsNothingMakesTheCauseAProposal) {
  const DiagnosisRun found = FoundDirection();
  const Diagnosis d = Judged(found, Showing(found, 0.0));
  EXPECT_FALSE(d.gain.positive);
  EXPECT_THAT(d.notes, Contains(kNoGainNote));
  EXPECT_LE(d.causes.front().probability, 0.6);
}

TEST(JudgeByFile, AFileThatTheBenchRefusesIsToldAndTheFitIsJudged) {
  const DiagnosisRun found = FoundDirection();
  const Diagnosis d = Judged(found, [&found](const auto&, const Scenario& scenario, Estimator) {
    if (scenario.effects.empty()) return found.run;
    throw InputError("extended.toml:7", "this cannot be built", "something else");
  });
  EXPECT_NEAR(d.gain.fraction_removed, 1.0, 0.05);
  EXPECT_THAT(d.notes, Contains(HasSubstr("that of the fit")));
  EXPECT_THAT(d.notes, Contains(HasSubstr("this cannot be built")));
}

}  // namespace
}  // namespace twinbench::diagnose
