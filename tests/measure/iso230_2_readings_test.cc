#include <gmock/gmock.h>

#include <cmath>
#include <map>

#include "tests/measure/positioning.h"
#include "tests/support/kept_text.h"
#include "twin/benches/encoder_comparison/estimators/vdi3441.h"
#include "twin/core/units.h"

namespace twinbench::measure {
namespace {

using testing::ElementsAre, testing::IsEmpty;

constexpr double kTurn_rad = 2.0 * units::kPi;

/// One pass through `stops` stops of a turn, the device ahead by position + 10 pass + half the direction [arcsec].
void AddPass(int stops, int pass, int direction, std::vector<Reading>& readings, int setup = 0) {
  for (int k = 0; k < stops; ++k) {
    Reading r;
    r.reading = static_cast<int>(readings.size());
    r.setup = setup;
    r.pass = pass;
    r.direction = direction;
    r.position = direction > 0 ? k : stops - 1 - k;
    r.reference_rad = kTurn_rad * r.position / stops;
    r.measured_rad = r.reference_rad + (r.position + 10.0 * pass + 0.5 * direction) * units::arcsec;
    r.velocity_rad_s = 0.0;
    readings.push_back(r);
  }
}

std::vector<Reading> Stops() {
  std::vector<Reading> readings;
  for (int pass = 0; pass < 4; ++pass) AddPass(8, pass, pass % 2 == 0 ? 1 : -1, readings);
  return readings;
}

void ExpectRuns(const std::vector<double>& runs_rad, const std::vector<double>& expected_arcsec) {
  ASSERT_EQ(runs_rad.size(), expected_arcsec.size());
  for (std::size_t i = 0; i < runs_rad.size(); ++i)  // a turn in rad rounds at 1e-15, 2e-10 arcsec
    EXPECT_NEAR(runs_rad[i] / units::arcsec, expected_arcsec[i], 1e-9);
}

TEST(PositioningOf, TakesARunFromEachPassAtEachStopAlsoIfPositionIsARunningNumber) {
  std::vector<Reading> running = Stops();
  for (Reading& r : running) r.position = r.reading;
  for (const std::vector<Reading>& readings : {Stops(), running}) {
    const PositioningStops stops = PositioningOf(readings, 0);
    ASSERT_EQ(stops.targets.size(), 8u);
    EXPECT_EQ(stops.left_out, 0);
    EXPECT_THAT(stops.notes, IsEmpty());
    EXPECT_DOUBLE_EQ(stops.targets[3].position, 3.0 * kTurn_rad / 8.0);
    ExpectRuns(stops.targets[3].forward, {3.5, 23.5});
    ExpectRuns(stops.targets[3].backward, {12.5, 32.5});
  }
}

TEST(PositioningOf, PutsTheTargetWhereTheReferenceStoodInTheMean) {
  std::vector<Reading> readings = Stops();
  for (Reading& r : readings) r.reference_rad += r.pass * units::arcsec;  // 0, 1, 2, 3
  const PositioningStops stops = PositioningOf(readings, 0);
  EXPECT_NEAR(stops.targets[2].position, kTurn_rad / 4.0 + 1.5 * units::arcsec, 1e-15);  // rounding
  EXPECT_THAT(stops.notes, IsEmpty());
}

TEST(PositioningOf, OrdersTargetsByAngle) {
  std::vector<Reading> readings = Stops();
  for (Reading& r : readings) r.position = 7 - r.position;
  const PositioningStops stops = PositioningOf(readings, 0);
  EXPECT_DOUBLE_EQ(stops.targets[1].position, kTurn_rad / 8.0);
  ExpectRuns(stops.targets[1].forward, {1.5, 21.5});
}

TEST(PositioningOf, DoesNotMindADeviceThatLosesItsTurns) {
  std::vector<Reading> readings = Stops();
  for (Reading& r : readings) r.measured_rad = std::fmod(r.measured_rad + 0.25 * kTurn_rad, kTurn_rad);
  const PositioningStops stops = PositioningOf(readings, 0);
  const double quarter_arcsec = 0.25 * kTurn_rad / units::arcsec;
  for (int i : {0, 7})
    ExpectRuns(stops.targets[static_cast<std::size_t>(i)].forward, {quarter_arcsec + i + 0.5, quarter_arcsec + i + 20.5});
}

TEST(PositioningOf, DoesNotMindAReferenceThatBeginsAgainAtATurn) {
  std::vector<Reading> readings = Stops();
  readings.back().reference_rad += kTurn_rad;  // position 0, last pass: 360 deg instead of 0
  const PositioningStops stops = PositioningOf(readings, 0);
  EXPECT_THAT(stops.notes, IsEmpty());
  EXPECT_NEAR(stops.targets[0].position, 0.0, 1e-15);
  ExpectRuns(stops.targets[0].backward, {9.5, 29.5});
}

TEST(PositioningOf, LeavesOutWhatIsNoStopAndCountsIt) {
  std::vector<Reading> readings = Stops();
  readings[1].status = ReadingStatus::kMissing;
  readings[2].velocity_rad_s = -0.1;
  readings[3].direction = 0;
  readings[4].velocity_rad_s = kNaN;  // not known: taken
  const PositioningStops stops = PositioningOf(readings, 0);
  EXPECT_EQ(stops.left_out, 3);
  for (std::size_t i : {1u, 2u, 3u}) EXPECT_EQ(stops.targets[i].forward.size(), 1u);
  EXPECT_EQ(stops.targets[4].forward.size(), 2u);
}

TEST(PositioningOf, KeepsToOneSetUp) {
  std::vector<Reading> readings = Stops();
  AddPass(8, 7, 1, readings, 1);
  readings.back().status = ReadingStatus::kMissing;
  EXPECT_EQ(PositioningOf(readings, 0).targets[0].forward.size(), 2u);
  const PositioningStops second = PositioningOf(readings, 1);
  EXPECT_EQ(second.targets.size(), 7u);
  EXPECT_EQ(second.left_out, 1);
  ExpectRuns(second.targets[0].forward, {70.5});
  EXPECT_THAT(PositioningOf(readings, 2).targets, IsEmpty());
}

TEST(PositioningOf, TakesTheMeanOfSeveralReadingsInOnePass) {
  std::vector<Reading> readings = Stops();
  readings.push_back(readings[16]);  // pass 2, position 0
  readings.back().measured_rad += 4.0 * units::arcsec;
  ExpectRuns(PositioningOf(readings, 0).targets[0].forward, {0.5, 22.5});
}

TEST(PositioningOf, NotesReadingsThatAreNotAtOneTarget) {
  std::vector<Reading> readings = Stops();
  readings[2].reference_rad += 0.6 * kTurn_rad / 8.0;
  readings[2].measured_rad += 0.6 * kTurn_rad / 8.0;
  ASSERT_EQ(PositioningOf(readings, 0).notes.size(), 1u);
  EXPECT_KEPT(PositioningOf(readings, 0).notes[0]);
}

TEST(PositioningOf, FeedsTheEvaluation) {
  // Forward runs of a target lie 20 arcsec apart, s = sqrt(200); backward ones too and 9 further on, B_i = -9.
  const auto p = EvaluatePositioning(PositioningOf(Stops(), 0).targets, {.replicas = 0});
  EXPECT_NEAR(p[AxisValue::kB].value / units::arcsec, 9.0, 1e-9);
  EXPECT_NEAR(p[AxisValue::kEForward].value / units::arcsec, 7.0, 1e-9);
  EXPECT_NEAR(p[AxisValue::kR].value / units::arcsec, 4.0 * std::sqrt(200.0) + 9.0, 1e-9);
}

std::vector<PositioningTarget> TestOf(std::size_t targets, std::size_t forward, std::size_t backward) {
  return std::vector(targets, PositioningTarget{0.0, std::vector<double>(forward), std::vector<double>(backward)});
}

TEST(MissingForRotaryAxis, WantsMoreTargetsForMoreTravel) {
  for (const auto& [travel_deg, targets] :
       {std::pair{30.0, 3u}, {90.0, 3u}, {90.0 + 1e-13, 3u}, {90.1, 5u}, {180.0, 5u}, {180.1, 8u}, {360.0, 8u}}) {
    EXPECT_THAT(MissingForRotaryAxis(TestOf(targets, 5, 5), travel_deg * units::deg), IsEmpty());
    const auto missing = MissingForRotaryAxis(TestOf(targets - 1, 5, 5), travel_deg * units::deg);
    ASSERT_EQ(missing.size(), 1u) << travel_deg;
    EXPECT_KEPT(missing[0]);
  }
}

TEST(MissingForRotaryAxis, WantsFiveRunsFromBothSides) {
  auto test = TestOf(8, 5, 6);
  EXPECT_THAT(MissingForRotaryAxis(test, kTurn_rad), IsEmpty());
  test[2].position = 0.5 * units::kPi;
  test[2].forward.pop_back();
  for (PositioningTarget& target : test) target.backward.clear();
  const auto missing = MissingForRotaryAxis(test, kTurn_rad);
  EXPECT_EQ(missing.size(), 2u);
  for (const std::string& one : missing) EXPECT_KEPT(one);
}

TEST(MissingForLinearAxis, WantsFiveTargetsAndFiveAMetre) {
  const auto over = [](int count, double travel_m) {
    std::vector<PositioningTarget> targets;
    for (int i = 0; i < count; ++i) targets.push_back({travel_m * i, std::vector(5, 0.0), std::vector(5, 0.0)});
    return MissingForLinearAxis(targets, travel_m, {"mm", 1e-3, "um", 1e-6});
  };
  EXPECT_THAT(over(5, 0.3), IsEmpty());
  for (const auto& missing : {over(4, 0.3), over(5, 1.2)}) {
    ASSERT_EQ(missing.size(), 1u);
    EXPECT_KEPT(missing[0]);
  }
  EXPECT_THAT(over(10, 3.0), IsEmpty()) << "above 2 m the standard asks otherwise";
}

TEST(PositioningText, PrintsArcsecAndADashForWhatIsNotThere) {
  PositioningTarget second = TwoRuns(-5.0, 3.0, 0.0, 0.0);
  second.position = 0.5 * units::kPi;
  second.backward = {2.0};
  std::vector<PositioningTarget> test = {TwoRuns(10.0, 1.0, 4.0, 2.0), second};
  for (PositioningTarget& target : test) {
    for (double& x : target.forward) x *= units::arcsec;
    for (double& x : target.backward) x *= units::arcsec;
  }
  EXPECT_KEPT(PositioningText(EvaluatePositioning(test, {.replicas = 0})));
}

using enum VdiValue;

VdiPositioning Evaluated(const std::vector<PositioningTarget>& targets) {
  return EvaluateVdi3441(EvaluatePositioning(targets, {.replicas = 0}).targets);
}

TEST(EvaluateVdi3441, GivesTheDefinitionsOnFiguresFoundByHand) {
  // Means 7 and -2, reversals 6 and 6, scatters 6 (1 + 2) / 2 = 9 and 6 (3 + 1) / 2 = 12.
  const VdiPositioning p = Evaluated({TwoRuns(10.0, 1.0, 4.0, 2.0), TwoRuns(-5.0, 3.0, 1.0, 1.0)});
  const std::map<VdiValue, double> by_hand = {{kP, 25.5},  // 7 + (6 + 9) / 2 - (-2 - (6 + 12) / 2)
                                              {kPs, 12.0},  {kMeanPs, 10.5}, {kPa, 9.0}, {kU, 6.0}, {kMeanU, 6.0}};
  for (const auto& [value, expected] : by_hand) EXPECT_NEAR(p[value].value, expected, 1e-13) << kVdiValueNames[static_cast<std::size_t>(value)];
}

/// Of one target P is U + Ps. Five runs a side with s = sqrt(2.5): s of five normal runs has the mean c4 s and the standard deviation
/// sqrt(1 - c4^2) s, c4 = 0.939986, and Ps = 3 (s+ + s-).
TEST(EvaluateVdi3441, StatesTheScatterOfOneTargetAsItsDistributionHasIt) {
  const double s = std::sqrt(2.5), c4 = 0.939986;
  const VdiPositioning p = Evaluated({{0.0, {9, 10, 11, 12, 13}, {-1, 0, 1, 2, 3}}});
  EXPECT_NEAR(p[kP].value, 10.0 + 6.0 * s, 1e-12);
  EXPECT_NEAR(p[kPs].value, 6.0 * s, 1e-12);
  EXPECT_EQ(p[kPa].value, 0.0);
  // 2000 replicas: u to 1.6 %, a mean to u / sqrt(2000); five times that.
  const double u_scatter = 3.0 * std::sqrt(2.0 * (1.0 - c4 * c4)) * s, u_reversal = std::sqrt(2.0 / 5.0) * s;
  EXPECT_NEAR(p[kPs].u, u_scatter, 0.08 * u_scatter);
  EXPECT_NEAR(p[kPs].bias, 6.0 * s * (c4 - 1.0), 5.0 * u_scatter / std::sqrt(2000.0));
  EXPECT_NEAR(p[kU].u, u_reversal, 0.08 * u_reversal);
  EXPECT_NEAR(p[kP].u, std::hypot(u_scatter, u_reversal), 0.08 * u_scatter);
}

/// What ISO 230-2 calls M and B are Pa and U here.
TEST(EvaluateVdi3441, SharesDeviationAndReversalWithIso230OnAPublishedTest) {
  const VdiPositioning p = Evaluated(PublishedLinearAxis());
  EXPECT_NEAR(p[kPa].value, 2.77e-5, 0.51e-8);  // half a unit of the last digit printed
  EXPECT_NEAR(p[kU].value, 1.22e-5, 0.51e-7);
  EXPECT_GE(p[kP].value, p[kPa].value);
  EXPECT_GE(p[kPs].value, p[kMeanPs].value);
}

TEST(EvaluateVdi3441, GivesNothingThatNeedsASideThatWasNotMeasured) {
  const VdiPositioning p = Evaluated({{0.0, {1, 2, 3}, {}}});
  for (const ScatteredValue& value : p.axis) EXPECT_TRUE(std::isnan(value.value));
  EXPECT_EQ(VdiText(p, {"deg", 1.0, "arcsec", 1.0}), "");
  EXPECT_TRUE(std::isnan(Evaluated({})[kP].value));
}

}  // namespace
}  // namespace twinbench::measure
