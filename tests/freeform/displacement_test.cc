#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>

#include "tests/core/input_error.h"
#include "twin/benches/evaluated.h"
#include "twin/benches/freeform_five_axis/columns.h"
#include "twin/benches/freeform_five_axis/estimators/far_shifts.h"
#include "twin/benches/freeform_five_axis/estimators/likely_sizes.h"
#include "twin/benches/freeform_five_axis/settings.h"
#include "twin/benches/registry.h"
#include "twin/core/stream.h"

// Displacements of balls at poses. The machines are written here as products of exact transforms; the program has
// slopes.
namespace twinbench::benches::freeform {
namespace {

using Eigen::Isometry3d, Eigen::Vector3d;
using units::arcsec, units::deg, units::mm, units::um;

using Errors = std::map<std::string, double>;  // "XOC" [um], "AOC" [arcsec], "EXC2c" of cos 2c

double Of(const Errors& errors, const std::string& name) {
  const auto found = errors.find(name);
  return found == errors.end() ? 0.0 : found->second;
}

/// What the body of an axis errs in one of X, Y, Z, A, B, C with the axis at this angle.
double ErrorOf(const Errors& errors, char what, char axis, double angle_rad) {
  double sum = Of(errors, std::string{what, 'O', axis});
  for (int order = 1; order <= 3; ++order) {
    const std::string name = std::string{'E', what, axis} + std::to_string(order);
    sum +=
        Of(errors, name + 'c') * std::cos(order * angle_rad) + Of(errors, name + 's') * std::sin(order * angle_rad);
  }
  return sum;
}

struct Axis {
  char letter;
  double sense;
  Vector3d to_mm;  // from what carries it
};

/// One rotary axis behind the next, with their errors.
Isometry3d Chain(const std::vector<Axis>& axes, const std::map<char, double>& turned_rad, const Errors& errors) {
  Isometry3d pose = Isometry3d::Identity();
  for (const Axis& axis : axes) {
    const double angle_rad = turned_rad.at(axis.letter);
    const auto error = [&](char what) { return ErrorOf(errors, what, axis.letter, angle_rad); };
    pose.translate(axis.to_mm * mm);
    pose.translate(Vector3d(error('X'), error('Y'), error('Z')) * um);
    const Vector3d tilt(error('A') * arcsec, error('B') * arcsec, error('C') * arcsec);
    if (tilt.norm() > 0.0) pose.rotate(Eigen::AngleAxisd(tilt.norm(), tilt.normalized()));
    pose.rotate(Eigen::AngleAxisd(axis.sense * angle_rad, Vector3d::Unit(axis.letter - 'A')));
  }
  return pose;
}

struct Machine {
  std::vector<Axis> table, head;
  Vector3d tool_mm = {0.0, 0.0, 0.0};
  Errors errors;

  /// Where the slides err, about the place of the table's first axis.
  Vector3d Slides_m(const Vector3d& at_m) const {
    const Vector3d p = table.empty() ? at_m : Vector3d(at_m - table.front().to_mm * mm);
    return arcsec *
           Vector3d(-Of(errors, "COY") * p.y() + Of(errors, "BOZ") * p.z(), -Of(errors, "AOZ") * p.z(), 0.0);
  }
};

struct Ball {
  Vector3d at_mm, off_um;
};

/// The slides go where an ideal machine has its tool at the ball.
Reading At(const Machine& m, const Ball& ball, int setup, const std::map<char, double>& turned_rad,
           bool seen_from_tool) {
  const Vector3d nominal_m = Chain(m.table, turned_rad, {}) * (ball.at_mm * mm);
  const Vector3d slides_m = nominal_m - Chain(m.head, turned_rad, {}) * (m.tool_mm * mm);
  const Vector3d ball_m = Chain(m.table, turned_rad, m.errors) * (ball.at_mm * mm + ball.off_um * um);
  const Vector3d tool_m = slides_m + m.Slides_m(slides_m) + Chain(m.head, turned_rad, m.errors) * (m.tool_mm * mm);
  Reading r;
  r.setup = setup;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto c = static_cast<Eigen::Index>(k);
    kCommanded[k](r) = slides_m[c];
    kShift_m[k](r) = (seen_from_tool ? 1.0 : -1.0) * (ball_m[c] - tool_m[c]);
    const char letter = static_cast<char>('A' + k);
    (k < 2 ? kCommanded[3 + k] : kCommandedC)(r) = turned_rad.contains(letter) ? turned_rad.at(letter) : 0.0;
  }
  return r;
}

/// Every ball at every pair of angles, with noise.
std::vector<Reading> Grid(const Machine& m, const std::vector<Ball>& balls,
                          const std::map<char, std::vector<double>>& angles_deg, bool seen_from_tool,
                          double noise_um = 0.0, int seed = 1) {
  Stream noise(static_cast<std::uint64_t>(seed), "displacement");
  std::vector<Reading> readings;
  const auto& [first, first_deg] = *angles_deg.begin();
  const auto& [second, second_deg] = *angles_deg.rbegin();
  for (std::size_t ball = 0; ball < balls.size(); ++ball) {
    for (const double a_deg : first_deg) {
      for (const double b_deg : second_deg) {
        readings.push_back(At(m, balls[ball], static_cast<int>(ball), {{first, a_deg * deg}, {second, b_deg * deg}},
                              seen_from_tool));
        for (const Quantity& shift : kShift_m) shift(readings.back()) += noise_um * um * noise.Normal();
        readings.back().reading = static_cast<int>(readings.size()) - 1;
      }
    }
  }
  return readings;
}

std::vector<double> Steps_deg(double from, double step, int count) {
  std::vector<double> all;
  for (int k = 0; k < count; ++k) all.push_back(from + step * k);
  return all;
}

Scenario Displacements(const std::vector<std::string>& set = {}) {
  std::vector<std::string> all = {"freeform_procedure.instrument=displacement"};
  all.insert(all.end(), set.begin(), set.end());
  return ParseScenario("bench = \"freeform_five_axis\"\n", "imported", "", all);
}

nlohmann::json ResultsOf(const std::vector<Reading>& readings, const std::vector<std::string>& set = {}) {
  return EvaluationOf(Displacements(set), readings, Estimator::kRigorous).results;
}

Machine TrunnionTable() {
  return {{{'A', -1.0, {250.0, -120.0, -400.0}}, {'C', 1.0, {0.0, 12.0, 0.0}}},
          {},
          {},
          {{"XOC", 12.0}, {"YOC", -7.0}, {"AOC", 9.0}, {"BOC", -3.0}, {"YOA", 8.0}, {"ZOA", -5.0}, {"BOA", 4.0},
           {"COA", -6.0}, {"COY", 5.0}, {"BOZ", -4.0}, {"AOZ", 3.0}}};
}

/// Two balls do not show what turns about the line through them.
const std::vector<Ball> kBalls = {{{100.0, 0.0, 50.0}, {20.0, -15.0, 10.0}},
                                  {{-40.0, 60.0, 120.0}, {-30.0, 5.0, 8.0}},
                                  {{10.0, -80.0, 20.0}, {4.0, 9.0, -12.0}}};
const std::map<char, std::vector<double>> kTilts = {{'A', Steps_deg(-90.0, 30.0, 5)},
                                                    {'C', Steps_deg(0.0, 30.0, 12)}};

/// What slopes leave out is of second order: an arcsec of a hundred of them, or of 0.1 m, is some nm.
constexpr double kSecondOrder = 0.02;

void ExpectLocations(const nlohmann::json& results, const Errors& truth) {
  for (const auto& [name, value] : truth) {
    if (name.front() == 'E') continue;
    ASSERT_TRUE(results.at("errors").contains(name)) << name << results.at("not_observable").dump();
    EXPECT_NEAR(results.at("errors").at(name).at("value").get<double>(), value, kSecondOrder) << name;
  }
}

/// (error / u)^2
double Pull2(const nlohmann::json& errors, const std::string& name, double truth) {
  const nlohmann::json& one = errors.at(name);
  return std::pow((one.at("value").get<double>() - truth) / one.at("u").get<double>(), 2);
}

double AmplitudeOf(const nlohmann::json& results, const std::string& name, int order) {
  if (!results.at("component_errors").contains(name)) return kNaN;
  for (const auto& one : results.at("component_errors").at(name))
    if (one.at("order") == order) return one.contains("amplitude") ? one.at("amplitude") : one.at("value");
  return kNaN;
}

TEST(Displacements, OfATiltingTableGiveItsElevenLocationsAndComponentErrorsByOrder) {
  Machine m = TrunnionTable();
  for (const auto& [name, value] :
       Errors{{"EXC2c", 3.0}, {"EXC2s", -4.0}, {"EZC3s", 2.0}, {"ECC1c", 4.0}, {"EAC2s", 2.5}})
    m.errors[name] = value;
  const nlohmann::json results = ResultsOf(Grid(m, kBalls, kTilts, true));
  ExpectLocations(results, m.errors);
  EXPECT_NEAR(AmplitudeOf(results, "EXC", 2), 5.0, kSecondOrder);
  EXPECT_NEAR(AmplitudeOf(results, "EZC", 3), 2.0, kSecondOrder);
  EXPECT_NEAR(AmplitudeOf(results, "EAC", 2), 2.5, kSecondOrder);
  EXPECT_NEAR(AmplitudeOf(results, "ECC", 1), 4.0, kSecondOrder);
  EXPECT_EQ(results.at("machine").at("topology"), "table_table");
  EXPECT_EQ(results.at("machine").at("axes")[0].at("right_handed"), false)
      << "A turns the table against the right-hand rule";
  EXPECT_EQ(results.at("instrument"), "displacement");
}

/// A ball alone does not say whether an axis moves, tilts or is late; it says that it does not.
TEST(Displacements, OfOneBallNameWhatItDoesNotShow) {
  Machine m = TrunnionTable();
  m.errors["ECC1c"] = 4.0;  // at 0.1 m: 1.9 um, once along the circle
  const nlohmann::json results = ResultsOf(
      Grid(m, {kBalls[0]}, {{'A', {0.0}}, {'C', Steps_deg(0.0, 15.0, 24)}}, true), {"displacement.axes=C"});
  EXPECT_TRUE(std::isnan(AmplitudeOf(results, "EXC", 2))) << "ECC of order 1 moves the ball alike";
  EXPECT_TRUE(std::isnan(AmplitudeOf(results, "ECC", 1)));
  EXPECT_TRUE(std::ranges::any_of(results.at("not_observable"), [](const nlohmann::json& one) {
    return one.at("error") == "ECC" && one.value("order", 0) == 1 &&
           one.at("indistinguishable_from").dump().find("EXC order 2") != std::string::npos;
  })) << results.at("not_observable").dump(1);
  EXPECT_LT(results.at("rank"), results.at("unknowns"));
}

TEST(Displacements, OfATurnTableAndATiltingHeadGiveTheirLocations) {
  const Machine m = {{{'C', 1.0, {10.0, 20.0, 0.0}}},
                     {{'B', 1.0, {0.0, 0.0, 0.0}}},
                     {3.0, 0.0, -180.0},
                     {{"XOC", 6.0}, {"YOC", 9.0}, {"AOC", -8.0}, {"BOC", 5.0}, {"AOB", 7.0}, {"COY", -6.0}}};
  const nlohmann::json results =
      ResultsOf(Grid(m, kBalls, {{'B', Steps_deg(-60.0, 30.0, 5)}, {'C', Steps_deg(0.0, 30.0, 12)}}, false));
  EXPECT_EQ(results.at("machine").at("topology"), "table_head");
  ExpectLocations(results, m.errors);
}

TEST(Displacements, OfAHeadOfTwoAxesGiveHowOneStandsToTheOther) {
  Machine m = {{},
               {{'C', 1.0, {0.0, 0.0, 0.0}}, {'A', 1.0, {0.0, 15.0, 0.0}}},
               {0.0, 0.0, -250.0},
               {{"YOA", 6.0}, {"BOA", 4.0}}};
  const nlohmann::json results =
      ResultsOf(Grid(m, {{{400.0, 300.0, -200.0}, {5.0, 6.0, 7.0}}},
                     {{'A', Steps_deg(-90.0, 30.0, 7)}, {'C', Steps_deg(0.0, 30.0, 12)}}, false));
  EXPECT_EQ(results.at("machine").at("topology"), "head_head");
  ExpectLocations(results, m.errors);
  EXPECT_FALSE(results.at("errors").contains("XOC")) << "the ball may stand anywhere";
}

/// Without dz nothing says how high A is, and a table that leans and a slide Z that leans are one: what is left is
/// told as before.
TEST(Displacements, MayBeFewerThanThree) {
  Machine m = TrunnionTable();
  std::vector<Reading> readings = Grid(m, kBalls, kTilts, true);
  for (Reading& r : readings) kShift_m[2](r) = kNaN;
  const nlohmann::json results = ResultsOf(readings);
  for (const char* not_told : {"AOC", "AOZ", "BOA", "BOZ", "ZOA"}) {
    EXPECT_FALSE(results.at("errors").contains(not_told)) << not_told;
    m.errors.erase(not_told);
  }
  ExpectLocations(results, m.errors);
}

constexpr int kNoisyRuns = 40;

/// Of the tilting table, read with noise again and again.
const std::vector<nlohmann::json>& NoisyResults() {
  static const std::vector<nlohmann::json> all = [] {
    std::vector<nlohmann::json> results;
    for (int seed = 1; seed <= kNoisyRuns; ++seed)
      results.push_back(ResultsOf(Grid(TrunnionTable(), kBalls, {{'A', kTilts.at('A')}, {'C', Steps_deg(0.0, 45.0, 8)}}, true, 0.3, seed)));
    return results;
  }();
  return all;
}

TEST(Displacements, StateAnUncertaintyThatMatchesTheirScatter) {
  const Errors truth = TrunnionTable().errors;
  double squares = 0.0;
  for (const nlohmann::json& results : NoisyResults())
    for (const auto& [name, value] : truth) squares += Pull2(results.at("errors"), name, value);
  // 440 values that go together in elevens: a standard deviation of sqrt(2 / 440) if they did not, some twice that.
  EXPECT_NEAR(squares / (kNoisyRuns * static_cast<double>(truth.size())), 1.0, 0.25);
}

TEST(Displacements, HaveNoDriftWhereNoneIsSeen) {
  EXPECT_LE(std::ranges::count_if(NoisyResults(), [](const nlohmann::json& results) { return results.contains("drift"); }), 2);
}

/// Errors of groups of four about a common mean: the restricted likelihood's maximum is that of the analysis of
/// variance.
TEST(Displacements, FindTheLikelySizeOfBelievedTermsAsAnAnalysisOfVarianceDoes) {
  constexpr int kGroups = 6, kEach = 4;
  Eigen::MatrixXd groups = Eigen::MatrixXd::Zero(kGroups * kEach, kGroups);
  Eigen::VectorXd between(kGroups * kEach), within(kGroups * kEach);
  for (int i = 0; i < kGroups * kEach; ++i) {
    groups(i, i / kEach) = 1.0;
    between[i] = std::array{3.0, -1.0, 4.0, -1.0, -5.0, 2.0}[static_cast<std::size_t>(i / kEach)];
    within[i] = i % 2 == 0 ? 1.0 : -1.0;
  }
  const Eigen::MatrixXd mean = Eigen::MatrixXd::Ones(kGroups * kEach, 1);
  const auto of = [](const Eigen::VectorXd& v) { return (v.array() - v.mean()).square().sum(); };
  const double of_between = of(between) / (kGroups - 1), of_within = of(within) / (kGroups * (kEach - 1));
  const double size = estimators::LikelySize(mean, groups, between + within);
  EXPECT_NEAR(std::log(size), 0.5 * std::log((of_between / of_within - 1.0) / kEach), std::log(1.25));
  EXPECT_EQ(estimators::LikelySize(mean, groups, 0.1 * between + within), 0.0)
      << "groups differ by less than their means scatter";
}

/// Means of cells, each told by its own four readings: a group's variance is the mean of their squares less what they
/// scatter.
TEST(Displacements, FindTheLikelySizesOfGroupsEachByItsOwnValues) {
  constexpr int kCells = 7, kEach = 4;
  const std::vector<int> groups = {0, 0, 1, 1, 2, 2};
  const std::array<double, kCells - 1> values = {50.0, -30.0, 4.0, 6.0, 0.05, -0.1};
  Eigen::MatrixXd cells = Eigen::MatrixXd::Zero(kCells * kEach, kCells);
  Eigen::VectorXd shifts_um(kCells * kEach);
  for (int i = 0; i < kCells * kEach; ++i) {
    cells(i, i / kEach) = 1.0;
    shifts_um[i] = (i / kEach > 0 ? values[static_cast<std::size_t>(i / kEach - 1)] : 0.0) + (i % 2 == 0 ? 1.0 : -1.0);
  }
  const Eigen::VectorXd sizes =
      estimators::LikelySizes(cells.leftCols(1), cells.rightCols(kCells - 1), groups,
                              Eigen::VectorXd{{0.0, 0.0, 0.0, 0.0, 0.5, 0.5}}, shifts_um)
          .sizes;
  const double noise2 = 1.0 * kCells * kEach / (kCells * kEach - 5);  // five means are free, two are held
  const auto of = [noise2](double a, double b) { return std::sqrt((0.5 * (a * a + b * b) - noise2 / kEach) / noise2); };
  EXPECT_NEAR(sizes[0] / of(50.0, 30.0), 1.0, 0.03);
  EXPECT_NEAR(sizes[3] / of(4.0, 6.0), 1.0, 0.03);
  EXPECT_DOUBLE_EQ(sizes[5], 0.5) << "no less than its least";
}

/// Over half a turn an order is nearly a sum of others and of a place of the axis: one that stands alone is neither
/// stated of others nor of the axis' line beyond what the uncertainty says.
TEST(Displacements, OverHalfATurnDoNotTakeOneOrderForOthersBeyondTheirUncertainty) {
  double squares = 0.0, count = 0.0;
  int seed = 0, seen = 0, alone = 0;
  for (const char* only : {"EYB2c", "EYB2s", "EXB2c", "EZB1s", "EZB3c", "EYB1c"}) {
    Machine m = {{{'B', 1.0, {250.0, -120.0, -400.0}}, {'C', 1.0, {0.0, 0.0, 0.0}}},
                 {},
                 {},
                 {{"XOB", -5.0}, {"ZOB", 8.0}, {"AOB", 6.0}, {"COB", 4.0}, {"XOC", 9.0}, {"YOC", 12.0}, {"AOC", -7.0}, {"BOC", 10.0}}};
    const Errors locations = m.errors;
    m.errors[only] = 5.0;
    const nlohmann::json results = ResultsOf(
        Grid(m, {kBalls[0], kBalls[1]}, {{'B', Steps_deg(-90.0, 30.0, 7)}, {'C', Steps_deg(0.0, 20.0, 18)}}, true, 0.2, ++seed));
    for (const auto& [name, value] : locations) squares += Pull2(results.at("errors"), name, value), count += 1.0;
    for (const auto& [name, orders] : results.at("component_errors").items()) {
      for (const auto& one : orders) {
        if (!one.contains("amplitude") || one.at("amplitude") < 4.0 * one.at("u_amplitude").get<double>()) continue;
        ++seen;
        alone += name + std::to_string(one.at("order").get<int>()) == std::string(only, 4) ? 1 : 0;
      }
    }
  }
  EXPECT_LT(squares / count, 1.5);
  EXPECT_GE(alone, 3) << "what is clear is told";
  EXPECT_EQ(alone, seen);
}

/// What has elapsed at a reading, from 0 to 1: by its time, or where there is none by its number.
double ElapsedAt(std::size_t i, std::size_t readings, bool has_times) {
  const double part = static_cast<double>(i) / static_cast<double>(readings - 1);
  return has_times ? (part - std::max(0.0, 0.5 * (part - 0.5))) / 0.75 : part;
}

/// Z of the machine grows while it is measured, at once or evenly, with a clock that tells that the second half took half
/// the time or without.
TEST(Displacements, ThatDriftOverTheRunAreThoseOfTheFirstReading) {
  constexpr double kDrift_um = 6.0;
  for (const bool has_times : {false, true}) {
    for (const bool is_even : {true, false}) {
      const Machine m = TrunnionTable();
      std::vector<Reading> readings = Grid(m, {kBalls[0], kBalls[1]}, kTilts, true, 0.2, is_even ? 1 : 2);
      for (std::size_t i = 0; i < readings.size(); ++i) {
        const double elapsed = ElapsedAt(i, readings.size(), has_times);
        if (has_times) readings[i].time = Time{} + FromSeconds(600.0 * elapsed);
        kShift_m[2](readings[i]) += kDrift_um * um * (is_even ? elapsed : elapsed * (2.0 - elapsed));
      }
      const report::Evaluation evaluation = EvaluationOf(Displacements(), readings, Estimator::kRigorous);
      const nlohmann::json drift = evaluation.results.at("drift").at("z_um");
      EXPECT_LT(drift.at("u"), 0.3);
      EXPECT_NEAR(drift.at("value"), kDrift_um, 3.0 * drift.at("u").get<double>());
      EXPECT_THAT(evaluation.summary, testing::HasSubstr("drift over the run: z "));
      for (const auto& [name, value] : m.errors) {
        EXPECT_LT(Pull2(evaluation.results.at("errors"), name, value), 16.0) << name;
        EXPECT_LT(evaluation.results.at("errors").at(name).at("u"), 0.4) << name;
      }
    }
  }
}

/// About a mean: what lies far is measured from the mean of the others, and a third of all is no outlier.
TEST(Displacements, FindSingleValuesFarFromTheFitOfAllOthers) {
  constexpr int kRows = 60;
  const Eigen::MatrixXd mean = Eigen::MatrixXd::Ones(kRows, 1);
  const std::vector<int> kinds(kRows, 0);
  std::vector<int> readings(kRows);
  std::iota(readings.begin(), readings.end(), 0);
  Eigen::VectorXd shifts_um(kRows);
  for (int i = 0; i < kRows; ++i) shifts_um[i] = i % 2 == 0 ? 1.0 : -1.0;
  EXPECT_TRUE(estimators::FarRows(mean, shifts_um, kinds, readings, 0.05).empty());
  shifts_um[7] = 50.0;
  const std::vector<estimators::FarRow> far = estimators::FarRows(mean, shifts_um, kinds, readings, 0.05);
  ASSERT_EQ(far.size(), 1U);
  EXPECT_EQ(far[0].row, 7);
  EXPECT_NEAR(far[0].off_um, 50.0 - 1.0 / (kRows - 1), 1e-9);
  for (int i = 0; i < kRows; i += 3) shifts_um[i] = 50.0;
  EXPECT_TRUE(estimators::FarRows(mean, shifts_um, kinds, readings, 0.05).empty());
}

/// A tool that touched something, once: nothing but that value is lost, with a drift or without.
TEST(Displacements, LeaveOutASingleValueThatNothingElseExplains) {
  for (const double drift_um : {0.0, 6.0}) {
    const Machine m = TrunnionTable();
    std::vector<Reading> readings = Grid(m, {kBalls[0], kBalls[1]}, kTilts, true, 0.2, 3);
    for (std::size_t i = 0; i < readings.size(); ++i)
      kShift_m[2](readings[i]) += drift_um * um * static_cast<double>(i) / static_cast<double>(readings.size() - 1);
    EXPECT_FALSE(ResultsOf(readings).contains("left_out"));
    kShift_m[0](readings[40]) += 8.0 * um;
    const report::Evaluation evaluation = EvaluationOf(Displacements(), readings, Estimator::kRigorous);
    ASSERT_EQ(evaluation.results.at("left_out").size(), 1U);
    EXPECT_EQ(evaluation.results.at("left_out")[0].at("reading"), 40);
    EXPECT_EQ(evaluation.results.at("left_out")[0].at("column"), "dx_um");
    EXPECT_NEAR(evaluation.results.at("left_out")[0].at("off_um"), 8.0, 1.0);
    EXPECT_THAT(evaluation.summary, testing::HasSubstr("doubtful: dx_um of reading 40 (row 41; A "));
    EXPECT_NEAR(evaluation.results.at("residual_rms").at("displacement_um"), 0.2, 0.04);
    for (const auto& [name, value] : m.errors) EXPECT_LT(Pull2(evaluation.results.at("errors"), name, value), 16.0) << name;
  }
}

/// A circle, or four angles, do not tell errors of the second order from squareness: the readings show that there
/// are some.
TEST(Displacements, StateInTheirUncertaintyWhatComponentsThatTheyDoNotTellMayBe) {
  constexpr int kMachines = 8;
  for (const auto& angles_deg : {std::map<char, std::vector<double>>{{'A', {0.0}}, {'C', Steps_deg(0.0, 15.0, 24)}},
                                 {{'A', {0.0, -30.0, -60.0}}, {'C', Steps_deg(0.0, 90.0, 4)}}}) {
    double squares = 0.0, count = 0.0;
    for (int seed = 1; seed <= kMachines; ++seed) {
      Machine m = TrunnionTable();
      Stream sizes(static_cast<std::uint64_t>(seed), "machine");
      for (const char* name : {"ECC2c", "ECC2s", "EAC2c", "EAC2s", "EXC2c", "EYC1s", "EBC1c"})
        m.errors[name] = 8.0 * sizes.Normal();
      const bool is_circle = angles_deg.at('A').size() == 1;
      const nlohmann::json errors =
          ResultsOf(Grid(m, {kBalls[0]}, angles_deg, true, 0.3, seed),
                    is_circle ? std::vector<std::string>{"displacement.axes=C"} : std::vector<std::string>{})
              .at("errors");
      for (const char* name : {"COY", "AOC", "BOC"})
        if (errors.contains(name)) squares += Pull2(errors, name, m.errors.at(name)), count += 1.0;
    }
    // A machine has seven of them, and few are told: far from normal, so that no mean of one is expected.
    EXPECT_GE(count, kMachines);
    EXPECT_LT(squares / count, 6.0) << "some hundreds without them";
  }
}

/// A ball whose place on the table is stated does not say which way the table turns, and a lean of its axis has
/// either sign.
TEST(Displacements, OfATableThatMayTurnEitherWayTellWhatDoesNotHangOnIt) {
  Machine m = TrunnionTable();
  std::vector<Reading> readings = Grid(m, {kBalls[0]}, {{'A', {0.0}}, {'C', Steps_deg(0.0, 15.0, 24)}}, true);
  for (Reading& r : readings)
    for (std::size_t k = 0; k < 3; ++k) kCommanded[k](r) = kBalls[0].at_mm[static_cast<Eigen::Index>(k)] * mm;
  const nlohmann::json either = ResultsOf(readings), said = ResultsOf(readings, {"displacement.axes=C"});
  EXPECT_FALSE(either.at("errors").contains("AOC"));
  EXPECT_FALSE(either.at("machine").at("also_possible").empty());
  EXPECT_NEAR(said.at("errors").at("AOC").at("value").get<double>(), 9.0, 0.1);
}

TEST(Displacements, AtPositionsOfNoSuchMachineAreRefused) {
  std::vector<Reading> readings = Grid(TrunnionTable(), kBalls, kTilts, true);
  for (std::size_t i = 0; i < readings.size(); ++i)
    kCommanded[0](readings[i]) += 3.0 * mm * std::sin(1.7 * static_cast<double>(i));
  EXPECT_THROW(ResultsOf(readings), InputError);
}

/// Twice the same poses: they repeat to 0.1 um, and a fifth order of 8 um is none of the fit's.
TEST(Displacements, ThatNoErrorOfTheMachineMakesHaveNoUncertainty) {
  std::vector<Reading> readings = Grid(TrunnionTable(), kBalls, kTilts, true, 0.1, 1);
  const std::vector<Reading> again = Grid(TrunnionTable(), kBalls, kTilts, true, 0.1, 2);
  readings.insert(readings.end(), again.begin(), again.end());
  for (Reading& r : readings)
    kShift_m[2](r) += 8.0 * um * std::cos(5.0 * kCommandedC(r)) * std::cos(3.0 * kCommanded[3](r));
  const report::Evaluation evaluation = EvaluationOf(Displacements(), readings, Estimator::kRigorous);
  EXPECT_TRUE(evaluation.IsRefuted());
  EXPECT_THAT(evaluation.summary, testing::HasSubstr("does not describe"));
}

TEST(Displacements, HaveNoDiagnosisAndNoSimulation) {
  const Scenario scenario = Displacements();
  const std::vector<Reading> readings = Grid(TrunnionTable(), kBalls, kTilts, true);
  EXPECT_THROW(diagnose::Diagnose(readings, scenario, {}), InputError);
  EXPECT_THROW(BenchOf(scenario).make_twin(scenario), InputError);
}

}  // namespace
}  // namespace twinbench::benches::freeform
