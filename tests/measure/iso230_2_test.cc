#include "tests/support/kept_text.h"
#include "twin/benches/encoder_comparison/estimators/vdi3441.h"
#include "twin/core/csv.h"
#include "twin/core/stream.h"

namespace twinbench::measure {
namespace {

// Tests of axes whose figures are known.

/// A target of two runs a side: means m, standard deviations s (two runs m -+ s / sqrt(2) have just that).
PositioningTarget TwoRuns(double mean_forward, double s_forward, double mean_backward, double s_backward) {
  const double f = s_forward / std::sqrt(2.0), b = s_backward / std::sqrt(2.0);
  return {0.0, {mean_forward - f, mean_forward + f}, {mean_backward - b, mean_backward + b}};
}

/// Measured figures of a linear axis [mm] with what its report prints; source and licence in the file.
std::vector<PositioningTarget> PublishedLinearAxis() {
  const CsvTable table = ReadCsv(TWINBENCH_TEST_DATA "/iso230_2/linear_axis.csv");
  std::map<double, PositioningTarget> by_target;
  for (const CsvTable::Row& row : table.rows) {
    const double target_mm = CsvNumber(table, row, 0, 1.0), actual_mm = CsvNumber(table, row, 3, 1.0);
    PositioningTarget& target = by_target[target_mm];
    (row.fields[1] == "1" ? target.forward : target.backward).push_back(actual_mm - target_mm);
  }
  std::vector<PositioningTarget> test;
  for (const auto& [position, target] : by_target) test.push_back(target);
  return test;
}

using Targets = std::vector<PositioningTarget>;
using enum AxisValue;

constexpr double kScatter = 0.3;

/// An axis with a long and a short period, reversal error and more scatter backward.
Targets Simulated(int targets, int runs, double scatter, Stream& noise) {
  Targets test;
  for (int i = 0; i < targets; ++i) {
    const double a = 2.0 * units::kPi * i / targets, curve = 3.0 * std::sin(a) + std::cos(3.0 * a);
    test.push_back({a, {}, {}});
    for (int j = 0; j < runs; ++j) {
      test.back().forward.push_back(curve + 0.5 + scatter * noise.Normal());
      test.back().backward.push_back(curve - 0.5 + 1.5 * scatter * noise.Normal());
    }
  }
  return test;
}

TEST(EvaluatePositioning, GivesTheDefinitionsOnFiguresFoundByHand) {
  // s is 1 and 2 at the first target, 3 and 1 at the second.
  const auto p = EvaluatePositioning({TwoRuns(10.0, 1.0, 4.0, 2.0), TwoRuns(-5.0, 3.0, 1.0, 1.0)});
  EXPECT_NEAR(p.targets[0].mean, 7.0, 1e-13);
  EXPECT_NEAR(p.targets[0].reversal, 6.0, 1e-13);
  EXPECT_NEAR(p.targets[1].reversal, -6.0, 1e-13);
  EXPECT_NEAR(p.targets[0].forward.deviation, 1.0, 1e-13);
  EXPECT_NEAR(p.targets[0].backward.Repeatability(), 8.0, 1e-13);
  EXPECT_NEAR(p.targets[0].repeatability.value, 12.0, 1e-13);  // 2 + 4 + 6
  EXPECT_NEAR(p.targets[1].repeatability.value, 14.0, 1e-13);  // 6 + 2 + 6
  const std::map<AxisValue, double> by_hand = {{kB, 6.0},         {kMeanB, 0.0}, {kRForward, 12.0},
                                               {kRBackward, 8.0}, {kR, 14.0},    {kEForward, 15.0},
                                               {kEBackward, 3.0}, {kE, 15.0},    {kM, 9.0},  // 7 and -2
                                               {kAForward, 23.0},                            // 12 - (-11)
                                               {kABackward, 9.0},  // 4 + 4 and 4 - 4, 1 + 2 and 1 - 2: 8 - (-1)
                                               {kA, 23.0}};
  for (const auto& [value, expected] : by_hand)
    EXPECT_NEAR(p[value].value, expected, 1e-13) << kAxisValueNames[static_cast<std::size_t>(value)];  // rounding
}

/// The report's R, 6.29e-5, is the larger of R+ and R-, not of the R_i, and its E, 2.46e-5, is less than its own E- = 3.30e-5, which cannot
/// be: both are wrong. R_5 = 6.882e-5 stands in the report's own column of R_i.
TEST(EvaluatePositioning, GivesThePublishedFiguresOfALinearAxis) {
  const Targets test = PublishedLinearAxis();
  ASSERT_EQ(test.size(), 5u);
  const auto p = EvaluatePositioning(test);
  const std::map<AxisValue, double> published_mm = {
      {kB, 1.22e-5},  {kMeanB, 5.4e-6},      {kRForward, 5.033e-5},  {kRBackward, 6.290e-5},
      {kR, 6.882e-5}, {kEForward, 2.46e-5},  {kEBackward, 3.30e-5},  {kE, 3.68e-5},
      {kM, 2.77e-5},  {kAForward, 6.428e-5}, {kABackward, 8.881e-5}, {kA, 8.881e-5}};
  for (const auto& [value, expected] : published_mm)  // half a unit of the last digit printed, 1e-8 mm, and rounding
    EXPECT_NEAR(p[value].value, expected, 0.51e-8) << kAxisValueNames[static_cast<std::size_t>(value)];
  const std::vector<double> repeatability_mm = {3.517e-5, 3.772e-5, 4.17e-5, 4.871e-5, 6.882e-5};
  for (std::size_t i = 0; i < 5; ++i) EXPECT_NEAR(p.targets[i].repeatability.value, repeatability_mm[i], 0.51e-8);
}

void ExpectNotAvailable(const AxisPositioning& p, std::vector<AxisValue> values) {
  for (const AxisValue value : values) {
    EXPECT_TRUE(std::isnan(p[value].value)) << kAxisValueNames[static_cast<std::size_t>(value)];
    EXPECT_TRUE(std::isnan(p[value].u)) << kAxisValueNames[static_cast<std::size_t>(value)];
  }
}

TEST(EvaluatePositioning, GivesOneDirectionOnlyIfOnlyOneWasMeasured) {
  Stream noise(5, "test");
  Targets test = Simulated(8, 5, kScatter, noise);
  const auto both = EvaluatePositioning(test);
  for (PositioningTarget& target : test) target.backward.clear();
  const auto one = EvaluatePositioning(test);
  for (const AxisValue value : {kRForward, kEForward, kAForward}) EXPECT_EQ(one[value].value, both[value].value);
  for (const AxisValue value : {kRForward, kEForward, kAForward}) EXPECT_GT(one[value].u, 0.0);
  ExpectNotAvailable(one, {kB, kMeanB, kRBackward, kR, kEBackward, kE, kM, kABackward, kA});
  EXPECT_TRUE(std::isnan(one.targets[3].reversal));
  EXPECT_EQ(one.targets[3].backward.runs, 0);
}

TEST(EvaluatePositioning, TakesWhateverRunsATargetHas) {
  // Means 2 and 0 forward, 1 and 1 backward; s by hand: {1, 2, 3} 1, {0, 0} 0, {1} none, {0, 1, 2} 1.
  const auto p = EvaluatePositioning({{0.0, {1, 2, 3}, {1}}, {1.0, {0, 0}, {0, 1, 2}}});
  EXPECT_EQ(p.targets[0].forward.runs, 3);
  EXPECT_DOUBLE_EQ(p[kRForward].value, 4.0);
  EXPECT_DOUBLE_EQ(p[kE].value, 2.0);
  EXPECT_DOUBLE_EQ(p[kB].value, 1.0);
  EXPECT_TRUE(std::isnan(p[kE].u));  // a mean of one run has no scatter to judge it by
  ExpectNotAvailable(p, {kRBackward, kR, kABackward, kA});
  const auto q = EvaluatePositioning({{0.0, {0, 1}, {1, 2, 3}}, {1.0, {0, 1}, {}}, {2.0, {0, 1}, {0, 1, 2}}});
  EXPECT_DOUBLE_EQ(q.targets[2].reversal, -0.5);
  ExpectNotAvailable(q, {kB, kMeanB, kRBackward, kR, kEBackward, kE, kM, kABackward, kA});
}

TEST(EvaluatePositioning, SaysNothingOfAnAxisWithoutTargetsAndRefusesADeviationThatIsNone) {
  const auto p = EvaluatePositioning({});
  EXPECT_TRUE(p.targets.empty());
  for (const ScatteredValue& v : p.axis) EXPECT_TRUE(std::isnan(v.value));
  EXPECT_THROW(EvaluatePositioning({{0.0, {1.0, kNaN}, {}}}), std::logic_error);
}

// Uncertainty. u comes from 20000 replicas: good to 1 / sqrt(2 * 20000) = 0.5 %; tolerances are four times that.
constexpr PositioningBootstrap kFine{.replicas = 20000, .seed = 1};
constexpr double kFour_sigma = 0.02;

TEST(EvaluatePositioning, PropagatesScatterToMeansAndReversal) {
  const PositioningTarget target{0.0, {1, 2, 3, 4}, {1, 2, 3, 4, 5, 6, 7, 8, 9}};  // s^2 is 5/3 and 7.5
  const auto p = EvaluatePositioning({target, target, target, target}, kFine);
  const double u_reversal = std::sqrt(5.0 / 12.0 + 7.5 / 9.0);
  EXPECT_NEAR(p.targets[0].forward.u_mean, std::sqrt(5.0 / 12.0), 1e-14);
  EXPECT_NEAR(p.targets[0].forward.u_deviation, std::sqrt(5.0 / 18.0), 1e-14);
  EXPECT_NEAR(p.targets[0].u_reversal, u_reversal, 1e-14);
  EXPECT_NEAR(p.targets[0].u_mean, 0.5 * u_reversal, 1e-14);
  EXPECT_NEAR(p[kMeanB].u / (0.5 * u_reversal), 1.0, kFour_sigma);  // mean of four
}

TEST(EvaluatePositioning, GivesClosedFormsWhereOneTargetDecides) {
  // Far apart, so that the same targets always are the largest and the smallest; five runs with s^2 = 2.5 each.
  const Targets test = {{0, {98, 99, 100, 101, 102}, {}}, {1, {-2, -1, 0, 1, 2}, {}}};
  const auto p = EvaluatePositioning(test, kFine);
  EXPECT_NEAR(p[kEForward].u, std::sqrt(2.5 / 5 + 2.5 / 5), kFour_sigma);
  EXPECT_NEAR(p[kEForward].bias, 0.0, 4.0 / std::sqrt(20000.0));  // its own standard uncertainty, u = 1
  // R+ of one target is 4 s sqrt(chi2_4 / 4): mean 4 s c4, deviation 4 s sqrt(1 - c4^2), c4(5) = 0.939986.
  const double r = 4.0 * std::sqrt(2.5), c4 = 0.939986;
  const auto one = EvaluatePositioning({test[0]}, kFine);
  EXPECT_NEAR(one[kRForward].u / (r * std::sqrt(1 - c4 * c4)), 1.0, kFour_sigma);
  EXPECT_NEAR(one[kRForward].bias / r, c4 - 1.0, 0.01);  // 0.34 / sqrt(20000) = 0.0024, four times
}

TEST(EvaluatePositioning, NamesWhatScatterAddsToARange) {
  // Two equal means with u = 1/2 each: the range is |N(0, 1/2)|, mean 1 / sqrt(pi), variance 1/2 - 1/pi.
  const PositioningTarget target{0.0, {-1, 0, 0, 1, 0, 0, -1, 1, 2, -2}, {}};
  const double u_mean = std::sqrt(12.0 / 90.0);
  const auto p = EvaluatePositioning({target, target}, kFine);
  EXPECT_DOUBLE_EQ(p[kEForward].value, 0.0);
  EXPECT_NEAR(p[kEForward].bias / u_mean, 2.0 / std::sqrt(units::kPi), kFour_sigma);
  EXPECT_NEAR(p[kEForward].u / u_mean, std::sqrt(2.0 - 4.0 / units::kPi), kFour_sigma);
}

TEST(EvaluatePositioning, IsCertainOfRunsThatAllAgree) {
  const auto p = EvaluatePositioning({{0, {1, 1}, {2, 2}}, {1, {5, 5}, {3, 3}}});
  for (const ScatteredValue& v : p.axis) {
    EXPECT_EQ(v.u, 0.0);
    EXPECT_EQ(v.bias, 0.0);
  }
}

TEST(EvaluatePositioning, RepeatsItselfWithASeed) {
  Stream noise(6, "test");
  const Targets test = Simulated(8, 5, kScatter, noise);
  const auto a = EvaluatePositioning(test), b = EvaluatePositioning(test);
  const auto other = EvaluatePositioning(test, {.replicas = 2000, .seed = 2});
  for (std::size_t i = 0; i < kAxisValues; ++i) {
    EXPECT_EQ(a.axis[i].u, b.axis[i].u);
    EXPECT_NE(a.axis[i].u, other.axis[i].u);
    EXPECT_NEAR(other.axis[i].u / a.axis[i].u, 1.0, 0.13);  // sqrt(2 / 4000) = 2.2 %, more for skew ones; six times
  }
}

/// 400 whole tests of one axis, each evaluated on its own.
struct Repeated {
  std::array<double, kAxisValues> mean{}, scatter{}, u{}, bias{};
};

Repeated RepeatTests() {
  constexpr int kTests = 400;
  Stream noise(7, "test");
  Repeated r;
  for (int k = 0; k < kTests; ++k) {
    const auto p = EvaluatePositioning(Simulated(8, 5, kScatter, noise), {.replicas = 200});
    for (std::size_t i = 0; i < kAxisValues; ++i) {
      r.mean[i] += p.axis[i].value / kTests;
      r.scatter[i] += p.axis[i].value * p.axis[i].value / kTests;
      r.u[i] += p.axis[i].u * p.axis[i].u / kTests;
      r.bias[i] += p.axis[i].bias / kTests;
    }
  }
  for (std::size_t i = 0; i < kAxisValues; ++i) {
    r.scatter[i] = std::sqrt(r.scatter[i] - r.mean[i] * r.mean[i]);
    r.u[i] = std::sqrt(r.u[i]);
  }
  return r;
}

TEST(EvaluatePositioning, StatesUncertaintyAndBiasOfTheScatterOfWholeTests) {
  const Repeated r = RepeatTests();
  const auto expect = [&](std::vector<AxisValue> values, double least, double most) {
    for (const AxisValue value : values) {
      const auto i = static_cast<std::size_t>(value);
      EXPECT_GT(r.u[i] / r.scatter[i], least) << kAxisValueNames[i];
      EXPECT_LT(r.u[i] / r.scatter[i], most) << kAxisValueNames[i];
    }
  };
  // The scatter of 400 is known to 1 / sqrt(800) = 3.5 %, four times that is 0.14.
  expect({kMeanB, kEForward, kEBackward, kE, kM}, 0.86, 1.14);
  // Where eight targets compete u is larger, as the header says; it must never be much smaller.
  expect({kB, kAForward, kABackward, kA}, 0.86, 1.5);
  expect({kRForward, kRBackward, kR}, 0.86, 2.0);
  const std::map<AxisValue, double> truth = {
      {kB, 1.0}, {kRForward, 4.0 * kScatter}, {kRBackward, 6.0 * kScatter}, {kR, 5.0 * kScatter + 1.0}};
  for (const auto& [value, true_value] : truth) {
    const auto i = static_cast<std::size_t>(value);
    EXPECT_GT(r.bias[i], 0.2 * (r.mean[i] - true_value)) << kAxisValueNames[i];  // half to all: see the header
    EXPECT_LT(r.bias[i], 1.1 * (r.mean[i] - true_value)) << kAxisValueNames[i];
  }
}

using testing::ElementsAre, testing::IsEmpty;

constexpr double kTurn_rad = 2.0 * units::kPi;

/// One pass through `stops` stops of a turn, the device ahead by position + 10 pass + half the direction [arcsec].
void AddPass(int stops, int pass, int direction, std::vector<Reading>& readings, int setup = 0) {
  for (int k = 0; k < stops; ++k) {
    Reading r{.reading = static_cast<int>(readings.size()), .setup = setup, .pass = pass, .direction = direction,
              .position = direction > 0 ? k : stops - 1 - k};
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

/// Of these stops with each reading changed.
PositioningStops Changed(const std::function<void(Reading&)>& change) {
  std::vector<Reading> readings = Stops();
  std::ranges::for_each(readings, change);
  return PositioningOf(readings, 0);
}

TEST(PositioningOf, PutsTheTargetWhereTheReferenceStoodInTheMeanAndOrdersTargetsByAngle) {
  const PositioningStops drifting =
      Changed([](Reading& r) { r.reference_rad += r.pass * units::arcsec; });               // 0, 1, 2, 3
  EXPECT_NEAR(drifting.targets[2].position, kTurn_rad / 4.0 + 1.5 * units::arcsec, 1e-15);  // rounding
  EXPECT_THAT(drifting.notes, IsEmpty());
  const PositioningStops renumbered = Changed([](Reading& r) { r.position = 7 - r.position; });
  EXPECT_DOUBLE_EQ(renumbered.targets[1].position, kTurn_rad / 8.0);
  ExpectRuns(renumbered.targets[1].forward, {1.5, 21.5});
}

TEST(PositioningOf, DoesNotMindADeviceThatLosesItsTurnsOrAReferenceThatBeginsAgainAtATurn) {
  const PositioningStops losing =
      Changed([](Reading& r) { r.measured_rad = std::fmod(r.measured_rad + 0.25 * kTurn_rad, kTurn_rad); });
  const double quarter_arcsec = 0.25 * kTurn_rad / units::arcsec;
  for (std::size_t i : {0u, 7u}) {
    const double at_arcsec = quarter_arcsec + static_cast<double>(i);
    ExpectRuns(losing.targets[i].forward, {at_arcsec + 0.5, at_arcsec + 20.5});
  }
  const PositioningStops again = Changed([](Reading& r) {  // position 0, last pass: 360 deg instead of 0
    if (r.reading == 31) r.reference_rad += kTurn_rad;
  });
  EXPECT_THAT(again.notes, IsEmpty());
  EXPECT_NEAR(again.targets[0].position, 0.0, 1e-15);
  ExpectRuns(again.targets[0].backward, {9.5, 29.5});
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

TEST(EvaluateVdi3441, GivesNothingThatNeedsASideThatWasNotMeasured) {
  const VdiPositioning p = Evaluated({{0.0, {1, 2, 3}, {}}});
  for (const ScatteredValue& value : p.axis) EXPECT_TRUE(std::isnan(value.value));
  EXPECT_EQ(VdiText(p, {"deg", 1.0, "arcsec", 1.0}), "");
  EXPECT_TRUE(std::isnan(Evaluated({})[kP].value));
}

}  // namespace
}  // namespace twinbench::measure
