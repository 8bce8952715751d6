#include "twin/diagnose/redundancy.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/core/input_error.h"
#include "tests/diagnose/ring_run.h"
#include "tests/support/kept_text.h"
#include "tests/support/rotary_scenario.h"
#include "tests/support/twin_run.h"
#include "twin/benches/names.h"
#include "twin/benches/rotary_4dof/settings.h"
#include "twin/diagnose/missing.h"

namespace twinbench::diagnose {
namespace {

using namespace test;
using testing::HasSubstr;

Eigen::VectorXd RedundancyOf(const LinearRun& run) {
  return ProjectorOf(run, WhiteNoise(run)).Redundancy();
}

std::string Refusal(const LinearRun& run) {
  return MessageOf([&] { RefuseWithoutRedundancy(run, RedundancyOf(run)); });
}

TEST(Redundancy, OfTwoSetUpsWithOnePassIsNone) {
  const LinearRun run = MakeRing({12, {0, 1}, {1}, 8});
  // 2 x 12 readings of a channel and 2 x 12 + 2 unknowns of which some are gauge; the calibration does not count.
  EXPECT_NEAR(CountDesign(run, RedundancyOf(run)).redundancy, 0.0, 1.0);
  EXPECT_THAT(Refusal(run), HasSubstr("procedure.passes = [1, -1, -1, 1]"));
  EXPECT_KEPT(Refusal(run));
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

std::string NotesOf(const std::vector<Reading>& readings, const std::string& bench) {
  return fmt::format("{}", fmt::join(MissingColumns(readings, bench), "\n"));
}

TEST(MissingColumns, NamesColumnsOrTheWholeCalibrationAndTheCausesThatAreLostOfACompleteRunNothing) {
  Reading calibration, circle;
  calibration.phase = Phase::kCalibration;
  EXPECT_KEPT(NotesOf({calibration, circle}, kRotaryBench));
  EXPECT_KEPT(NotesOf({Reading{}}, kRotaryBench));
  EXPECT_KEPT(NotesOf({Reading{}}, kEncoderBench));
  Scenario scenario = twinbench::test::RotaryScenario();
  RotaryOf(scenario).procedure.positions = 12;
  EXPECT_EQ(NotesOf(twinbench::test::RunTwin(scenario).readings, kRotaryBench), "");
}

}  // namespace
}  // namespace twinbench::diagnose
