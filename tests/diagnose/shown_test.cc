#include <fmt/ranges.h>

#include "tests/core/input_error.h"
#include "tests/diagnose/ring_run.h"
#include "tests/support/kept_text.h"
#include "tests/support/rotary_scenario.h"
#include "tests/support/twin_run.h"
#include "twin/core/units.h"
#include "twin/diagnose/missing.h"
#include "twin/diagnose/redundancy.h"
#include "twin/diagnose/shown.h"

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

TEST(Redundancy, OfRepeatedPassesOrAThirdSetUpIsEnoughAndNotAskedOfACalibrationAlone) {
  for (const RingShape& shape :
       {RingShape{12, {0, 1}, {1, -1}, 8}, RingShape{12, {0, 1, 5}, {1}, 8}, RingShape{12, {}, {}, 8}}) {
    const LinearRun run = MakeRing(shape);
    EXPECT_NO_THROW(RefuseWithoutRedundancy(run, RedundancyOf(run)));
  }
}

std::string NotesOf(const std::vector<Reading>& readings, const std::string& bench) {
  return fmt::format("{}", fmt::join(MissingColumns(readings, bench), "\n"));
}

TEST(MissingColumns, NamesColumnsOrTheWholeCalibrationAndTheCausesThatAreLostOfACompleteRunNothing) {
  Reading calibration, circle;
  calibration.phase = Phase::kCalibration;
  EXPECT_KEPT(NotesOf({calibration, circle}, kRotaryBench));
  EXPECT_KEPT(NotesOf({Reading{}}, kRotaryBench));
  for (const char* bench : {kEncoderBench, kTurntableBench}) EXPECT_KEPT(NotesOf({Reading{}}, bench));
  Scenario scenario = twinbench::test::RotaryScenario();
  RotaryOf(scenario).procedure.positions = 12;
  EXPECT_EQ(NotesOf(twinbench::test::RunTwin(scenario).readings, kRotaryBench), "");
}

/// A sweep forth and back without noise, with what two causes show: a wave of 10 sigma, a wave of 5 sigma.
struct TwoWaves {
  TwoWaves() {
    found.run = SyntheticSweep(400);
    const Eigen::VectorXd& angle_rad = found.run.schedule.reference_rad;
    found.noise.sigma = found.run.sigma;
    large = 10.0 * found.run.sigma[0] * (12.0 * angle_rad.array()).cos();
    small = 5.0 * found.run.sigma[0] * (28.0 * angle_rad.array()).cos();
    found.run.residual = large + small;
    for (const char* effect : {"large", "small", "decided before"}) {
      found.diagnosis.causes.emplace_back();
      found.diagnosis.causes.back().effect = effect;
    }
  }
  DiagnosisRun found;
  Eigen::VectorXd large, small;
};

TEST(ShownBy, SharesTheVarianceAmongTheCauses) {
  TwoWaves waves;
  waves.found.accepted = {TermOf("small", waves.small, 1.0), TermOf("large", waves.large, 1.0)};
  const Shown shown = ShownBy(waves.found);
  ASSERT_EQ(shown.share.size(), 3u);
  // Powers 100 to 25. The waves are not quite orthogonal on the unequal steps of the sweep: some hundredths.
  EXPECT_NEAR(shown.share[0], 0.8, 0.05);
  EXPECT_NEAR(shown.share[1], 0.2, 0.05);
  EXPECT_NEAR(shown.share[0] + shown.share[1], 1.0, 1e-3);  // all that there is
  EXPECT_TRUE(std::isnan(shown.share[2]));
  EXPECT_TRUE(std::isnan(shown.share_unnamed));
}

TEST(ShownBy, LeavesTheShareOfWhatWasNotAccepted) {
  TwoWaves waves;
  waves.found.accepted = {TermOf("wave", waves.small, 1.0, Kind::kUnknown)};
  const Shown shown = ShownBy(waves.found);
  EXPECT_TRUE(std::isnan(shown.share[0]));
  EXPECT_NEAR(shown.share_unnamed, 0.2, 0.05);
}

TEST(ShownBy, GivesNoCauseMoreThanThereIs) {
  TwoWaves waves;
  const Eigen::VectorXd all = waves.large + waves.small;
  waves.found.accepted = {TermOf("large", 1.3 * all, 1.0),
                          TermOf("small", -0.3 * all, 1.0)};  // one takes back what the other has too much
  const Shown shown = ShownBy(waves.found);
  EXPECT_LE(shown.share[0], 1.0);
  EXPECT_LT(shown.share[1], 0.0);
}

/// A device that reads `half` more going forward and as much less going backward, at four stops of two turns.
DiagnosisRun StopsWithPlay(double half_deg) {
  DiagnosisRun found;
  LinearRun& run = found.run = SyntheticSweep(16);
  Schedule& s = run.schedule;
  for (int i = 0; i < 16; ++i) {
    const auto k = static_cast<std::size_t>(i);
    s.pass[k] = i / 8;
    s.direction[k] = i < 8 ? 1 : -1;
    s.reference_rad[i] = 90.0 * units::deg * (i < 8 ? i : 15 - i);
    run.residual[i] = s.direction[k] * half_deg * units::deg;
  }
  run.unit = "deg";
  run.to_SI = units::deg;
  found.noise.sigma = run.sigma;
  return found;
}

TEST(ErrorCurve, HoldsBothDirectionsAtThePlacesOfOneTurn) {
  const ErrorCurve curve = ShownBy(StopsWithPlay(0.25)).curve;
  EXPECT_EQ(curve.unit, "deg");
  EXPECT_EQ(curve.along, "angle");
  EXPECT_EQ(curve.along_unit, "deg");
  ASSERT_EQ(curve.x.size(), 4u);  // eight stops of two turns
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_NEAR(curve.x[k], 90.0 * static_cast<double>(k), 1e-6);
    EXPECT_NEAR(curve.forward[k], 0.25, 1e-9);
    EXPECT_NEAR(curve.backward[k], -0.25, 1e-9);
  }
}

TEST(ErrorCurve, OfALinearAxisIsAgainstItsPosition) {
  DiagnosisRun found = StopsWithPlay(0.25);
  // A turn of the bench's angle is 2 mm of way: 90 deg are 0.5 mm.
  found.run.bench = kEncoderBench;
  found.run.unit = "mm";
  found.run.to_SI = 180.0 * units::deg;
  const ErrorCurve curve = ShownBy(found).curve;
  EXPECT_EQ(curve.along, "position");
  EXPECT_EQ(curve.along_unit, "mm");
  ASSERT_EQ(curve.x.size(), 8u);  // a way has no turns
  EXPECT_NEAR(curve.x[7], 3.5, 1e-9);
  EXPECT_EQ(curve.unit, "um");  // small as it is
  EXPECT_NEAR(curve.forward[7], 1000.0 * 0.25 / 180.0, 1e-6);
}

TEST(ErrorCurve, GathersManyPlacesAndLeavesRestsOut) {
  DiagnosisRun found;
  found.run = SyntheticSweep(4000);
  found.noise.sigma = found.run.sigma;
  found.run.schedule.direction.assign(4000, 1);
  found.run.schedule.direction[17] = 0;
  found.run.residual[17] = 1.0;  // a rest that would be seen
  const ErrorCurve curve = ShownBy(found).curve;
  EXPECT_EQ(curve.x.size(), static_cast<std::size_t>(kCurvePlaces));
  for (const double backward : curve.backward) EXPECT_TRUE(std::isnan(backward));
  for (const double forward : curve.forward) EXPECT_LT(std::abs(forward), 1000.0);
}

TEST(IsSignificant, MeansThatNoiseSeldomShowsSuchAnOrder) {
  // exp(-a^2 / 2 u^2) = 0.01 / 12 at a = 3.77 u.
  EXPECT_FALSE(IsSignificant({1, 3.7, 1.0, 0.0, 0.1, ""}, 12));
  EXPECT_TRUE(IsSignificant({1, 3.8, 1.0, 0.0, 0.1, ""}, 12));
  EXPECT_FALSE(IsSignificant({1, kNaN, kNaN, 0.0, 0.1, ""}, 12));
}

}  // namespace
}  // namespace twinbench::diagnose
