#include "twin/benches/encoder_comparison/estimators/iso230_2.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "tests/measure/positioning.h"
#include "twin/core/stream.h"
#include "twin/core/units.h"

namespace twinbench::measure {
namespace {

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
  const auto expect = [&](AxisValue value, double by_hand) {
    EXPECT_NEAR(p[value].value, by_hand, 1e-13) << kAxisValueNames[static_cast<std::size_t>(value)];  // rounding
  };
  EXPECT_NEAR(p.targets[0].mean, 7.0, 1e-13);
  EXPECT_NEAR(p.targets[0].reversal, 6.0, 1e-13);
  EXPECT_NEAR(p.targets[1].reversal, -6.0, 1e-13);
  EXPECT_NEAR(p.targets[0].forward.deviation, 1.0, 1e-13);
  EXPECT_NEAR(p.targets[0].backward.Repeatability(), 8.0, 1e-13);
  EXPECT_NEAR(p.targets[0].repeatability.value, 12.0, 1e-13);  // 2 + 4 + 6
  EXPECT_NEAR(p.targets[1].repeatability.value, 14.0, 1e-13);  // 6 + 2 + 6
  expect(kB, 6.0);
  expect(kMeanB, 0.0);
  expect(kRForward, 12.0);
  expect(kRBackward, 8.0);
  expect(kR, 14.0);
  expect(kEForward, 15.0);
  expect(kEBackward, 3.0);
  expect(kE, 15.0);
  expect(kM, 9.0);          // 7 and -2
  expect(kAForward, 23.0);  // 12 - (-11)
  expect(kABackward, 9.0);  // 4 + 4 and 4 - 4, 1 + 2 and 1 - 2: 8 - (-1)
  expect(kA, 23.0);
}

TEST(EvaluatePositioning, TakesTheLargestOfThreeForTheBidirectionalRepeatability) {
  // 2 s+ + 2 s- + |B| = 2 + 0.2 + 0.5 is less than 4 s+ = 4.
  const auto p = EvaluatePositioning({TwoRuns(0.5, 1.0, 0.0, 0.1), TwoRuns(0.5, 0.1, 0.0, 1.1)});
  EXPECT_NEAR(p.targets[0].repeatability.value, 4.0, 1e-13);
  EXPECT_NEAR(p.targets[1].repeatability.value, 4.4, 1e-13);
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

}  // namespace
}  // namespace twinbench::measure
