#include "twin/diagnose/redundancy.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/core/input_error.h"
#include "tests/diagnose/ring_run.h"
#include "tests/support/rotary_scenario.h"
#include "tests/support/twin_run.h"
#include "twin/benches/names.h"
#include "twin/benches/rotary_4dof/diagnosis/rotary_run.h"
#include "twin/benches/rotary_4dof/settings.h"
#include "twin/benches/rotary_4dof/twin/factory.h"
#include "twin/diagnose/missing.h"

namespace twinbench::diagnose {
namespace {

using namespace test;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

Eigen::VectorXd RedundancyOf(const LinearRun& run) {
  return Projector(WhiteNoise(run).Whiten(run, run.nuisance.jacobian), run.nuisance).Redundancy();
}

std::string Refusal(const LinearRun& run) {
  return MessageOf([&] { RefuseWithoutRedundancy(run, RedundancyOf(run)); });
}

TEST(Redundancy, OfTwoSetUpsWithOnePassIsNone) {
  const LinearRun run = MakeRing({12, {0, 1}, {1}, 8});
  // 2 x 12 readings of a channel and 2 x 12 + 2 unknowns of which some are gauge; the calibration does not count.
  EXPECT_NEAR(CountDesign(run, RedundancyOf(run)).redundancy, 0.0, 1.0);
  EXPECT_THAT(Refusal(run),
              AllOf(HasSubstr("2 set-ups with 1 pass each leave 0 degrees of freedom in 48 values"),
                    HasSubstr("expected at least a third set-up"), HasSubstr("procedure.passes = [1, -1, -1, 1]")));
}

TEST(Redundancy, OfRepeatedPassesOrAThirdSetUpIsEnough) {
  for (const RingShape& shape : {RingShape{12, {0, 1}, {1, -1}, 8}, RingShape{12, {0, 1, 5}, {1}, 8}}) {
    const LinearRun run = MakeRing(shape);
    EXPECT_NO_THROW(RefuseWithoutRedundancy(run, RedundancyOf(run)));
  }
}

TEST(Redundancy, IsNotAskedOfACalibrationAlone) {
  const LinearRun run = MakeRing({12, {}, {}, 8});
  EXPECT_NO_THROW(RefuseWithoutRedundancy(run, RedundancyOf(run)));
}

TEST(Redundancy, OfThePublishedDesignOnTheRotaryBenchIsNone) {
  Scenario scenario = twinbench::test::RotaryScenario();
  RotaryOf(scenario).procedure.positions = 24;
  RotaryOf(scenario).procedure.shifts = {0, 1};
  RotaryOf(scenario).procedure.passes = {1};
  const auto run =
      rotary::BuildRun(twinbench::test::RunTwin(scenario).readings, scenario, {benches::rotary::FollowRecord}).run;
  EXPECT_THAT(Refusal(run), HasSubstr("2 set-ups with 1 pass each leave 0 degrees of freedom in 192 values"));
}

TEST(MissingColumns, NamesColumnsAndTheCausesThatAreLost) {
  Reading calibration, circle;
  calibration.phase = Phase::kCalibration;
  const auto notes = MissingColumns({calibration, circle}, kRotaryBench);
  EXPECT_THAT(notes, ElementsAre(AllOf(HasSubstr("dwell_s"), HasSubstr("settling")),
                                 AllOf(HasSubstr("temperature_degC"), HasSubstr("thermal_tilt")),
                                 AllOf(HasSubstr("n_samples"), HasSubstr("noise")),
                                 AllOf(HasSubstr("autocollimator_yaw_arcsec"), HasSubstr("psd_gain"))));
}

TEST(MissingColumns, SaysWhenTheWholeCalibrationIsMissing) {
  const auto notes = MissingColumns({Reading{}}, kRotaryBench);
  EXPECT_THAT(notes.back(), HasSubstr("no calibration readings"));
}

TEST(MissingColumns, HasNothingToSayOfACompleteRun) {
  Scenario scenario = twinbench::test::RotaryScenario();
  RotaryOf(scenario).procedure.positions = 12;
  EXPECT_THAT(MissingColumns(twinbench::test::RunTwin(scenario).readings, kRotaryBench), IsEmpty());
}

TEST(MissingColumns, OfAnAngleComparisonAreItsOwn) {
  EXPECT_THAT(MissingColumns({Reading{}}, kEncoderBench),
              ElementsAre(HasSubstr("velocity_deg_s"), HasSubstr("temperature_degC")));
}

}  // namespace
}  // namespace twinbench::diagnose
