#include "twin/separate/error_motion.h"

#include <numbers>

#include "twin/core/stream.h"
#include "twin/core/units.h"
#include "twin/separate/widest_range.h"

/// Figures of ISO 230-7 against motions whose figures are known in closed form.
namespace twinbench::separate {
namespace {

constexpr Eigen::Index kAngles = 360;
constexpr double kUm = units::um;
constexpr double kRoundingUm = 1e-9;

Eigen::ArrayXd Angles(Eigen::Index n = kAngles) {
  return Eigen::ArrayXd::LinSpaced(n, 0.0, units::turn * static_cast<double>(n - 1) / static_cast<double>(n));
}

ErrorMotion Motion(const Eigen::ArrayXd& contour_um, std::vector<double> turns_um = {}) {
  for (double& t : turns_um) t *= kUm;
  const Eigen::ArrayXd angles = Angles(contour_um.size());
  return {angles.matrix(), (contour_um * kUm).matrix(), {}, std::vector(static_cast<std::size_t>(contour_um.size()), turns_um)};
}

TEST(ErrorMotion, OfALobedContourHasTheWidthOfItsLobesWhereverTheArtefactStands) {
  const Eigen::ArrayXd t = Angles();
  const Eigen::ArrayXd lobes = 0.4 * (3.0 * t).cos();  // width 0.8
  const Eigen::ArrayXd eccentric = lobes + 25.0 * (t - 0.7).cos() + 3.0;
  for (const Eigen::ArrayXd& contour : {lobes, eccentric}) {
    const ErrorMotionValues v = EvaluateErrorMotion(Motion(contour, {-0.1, 0.0, 0.15}), PlotCentre::kLeastSquares);
    EXPECT_NEAR(v.synchronous.value / kUm, 0.8, kRoundingUm);
    EXPECT_NEAR(v.asynchronous.value / kUm, 0.25, kRoundingUm);
    EXPECT_NEAR(v.total.value / kUm, 0.8 + 0.25, kRoundingUm);
    EXPECT_EQ(v.turns, 3);
    EXPECT_TRUE(std::isnan(v.fundamental.value)) << "what turns once is no radial motion";
  }
}

TEST(ErrorMotion, TotalIsTakenWhereverATurnIsOutermost) {
  const Eigen::ArrayXd t = Angles();
  ErrorMotion motion = Motion(0.4 * (2.0 * t).cos(), {-0.01, 0.01});
  motion.scatter[45] = {-0.7 * kUm, 0.9 * kUm};  // where the contour is 0
  const ErrorMotionValues v = EvaluateErrorMotion(motion, PlotCentre::kLeastSquares);
  EXPECT_NEAR(v.asynchronous.value / kUm, 1.6, kRoundingUm);
  EXPECT_NEAR(v.total.value / kUm, 0.9 + 0.7, kRoundingUm);
  EXPECT_NEAR(v.synchronous.value / kUm, 0.8, kRoundingUm);
}

TEST(ErrorMotion, KeepsTheFundamentalOfAxialMotionAndStatesTheRestBesideIt) {
  const Eigen::ArrayXd t = Angles();
  const double e = 0.6, a = 0.5;  // e cos t + a cos 2t lies between e + a and -a - e^2 / (8 a), for e < 4 a
  const ErrorMotionValues v = EvaluateErrorMotion(Motion(e * t.cos() + a * (2.0 * t).cos() + 8.0, {0.0}), PlotCentre::kPolarChart);
  EXPECT_NEAR(v.synchronous.value / kUm, e + 2.0 * a + e * e / (8.0 * a), 1e-4) << "to half a degree at a flat minimum";
  EXPECT_NEAR(v.fundamental.value / kUm, 2.0 * e, kRoundingUm);
  EXPECT_NEAR(v.residual.value / kUm, 2.0 * a, kRoundingUm);
  EXPECT_NEAR(v.total.value, v.synchronous.value, 1e-15) << "one turn is its own contour";
  EXPECT_TRUE(std::isnan(v.asynchronous.value)) << "one turn has no scatter";
}

TEST(ErrorMotion, DependsOnTheSensitiveDirection) {
  const Eigen::ArrayXd t = Angles();
  const ErrorMotion none = Motion(Eigen::ArrayXd::Zero(kAngles), {0.0, 0.0});
  // x = cos 2t alone: 2 in a fixed direction; along one that turns cos t cos 2t = (cos t + cos 3t) / 2, of which cos t is the centre.
  const ErrorMotion x = Motion((2.0 * t).cos(), {-0.1, 0.1});
  EXPECT_NEAR(EvaluateErrorMotion(x, PlotCentre::kLeastSquares).synchronous.value / kUm, 2.0, kRoundingUm);
  const ErrorMotionValues turned = EvaluateErrorMotion(Rotating(x, none), PlotCentre::kLeastSquares);
  EXPECT_NEAR(turned.synchronous.value / kUm, 1.0, kRoundingUm);
  EXPECT_NEAR(turned.asynchronous.value / kUm, 0.2, kRoundingUm) << "at 0 deg, where it looks along x";
  // Turns that are apart along the diagonal at 45 deg alone: it looks along it there.
  ErrorMotion dx = none, dy = none;
  dx.scatter[45] = dy.scatter[45] = {-0.1 * kUm, 0.1 * kUm};
  EXPECT_NEAR(EvaluateErrorMotion(Rotating(dx, dy), PlotCentre::kLeastSquares).asynchronous.value / kUm,
              0.2 * std::sqrt(2.0), kRoundingUm);
  // An eccentric artefact stands still beside a tool that turns with it.
  const ErrorMotion ex = Motion(5.0 * (t + 0.3).cos()), ey = Motion(5.0 * (t + 0.3).sin());
  EXPECT_NEAR(EvaluateErrorMotion(Rotating(ex, ey), PlotCentre::kLeastSquares).synchronous.value / kUm, 0.0, kRoundingUm);
}

/// Where two points stand out far, the width is their difference and its uncertainty in closed form.
TEST(ErrorMotion, UncertaintyOfAWidthIsThatOfItsEnds) {
  Eigen::ArrayXd contour_um = Eigen::ArrayXd::Zero(72);
  contour_um[10] = 4.0;
  contour_um[40] = -3.0;
  ErrorMotion motion = Motion(contour_um);
  motion.cov = Eigen::MatrixXd::Identity(72, 72) * std::pow(0.05 * kUm, 2);
  const ErrorMotionValues v = EvaluateErrorMotion(motion, PlotCentre::kPolarChart, {.number = 4000});
  EXPECT_NEAR(v.synchronous.value / kUm, 7.0, kRoundingUm);
  EXPECT_NEAR(v.synchronous.u / kUm, std::sqrt(2.0) * 0.05, 0.04 * 0.0707) << "4000 replicas: 1.1 %";
  EXPECT_NEAR(v.synchronous.bias / kUm, 0.0, 4.0 * 0.0707 / std::sqrt(4000.0));
  EXPECT_NEAR(std::sqrt(v.slope.dot(motion.cov * v.slope)) / kUm, std::sqrt(2.0) * 0.05, 1e-12);
}

TEST(ErrorMotion, NoiseOfAFlatContourIsSaidToBeBias) {
  ErrorMotion motion = Motion(Eigen::ArrayXd::Zero(36));
  motion.cov = Eigen::MatrixXd::Identity(36, 36) * kUm * kUm;
  const ErrorMotionValues v = EvaluateErrorMotion(motion, PlotCentre::kPolarChart, {.number = 4000});
  // Mean range of 36 normal numbers: 4.24 standard deviations; its standard deviation 0.70 (Tippett, Biometrika 17 (1925)).
  EXPECT_NEAR(v.synchronous.bias / kUm, 4.24, 0.05);
  EXPECT_NEAR(v.synchronous.u / kUm, 0.70, 0.03);
}

TEST(ErrorMotion, AsynchronousOfNormalScatterIsItsRange) {
  // Eight turns: range d2 = 2.847 standard deviations, of standard deviation d3 = 0.820 (any table of control charts).
  constexpr double kD2 = 2.847, kD3 = 0.820;
  constexpr int kTests = 400, kTurns = 8;
  Stream normal(3, "test.turns");
  double sum_value = 0.0, sum_u2 = 0.0;
  for (int test = 0; test < kTests; ++test) {
    ErrorMotion motion = Motion(Eigen::ArrayXd::Zero(4), std::vector(kTurns, 0.0));
    for (double& turn : motion.scatter[2]) turn = normal.Normal() * kUm;  // the other angles scatter not at all
    const ErrorMotionValues v = EvaluateErrorMotion(motion, PlotCentre::kLeastSquares, {.number = 100});
    sum_value += v.asynchronous.value / kUm;
    sum_u2 += std::pow(v.asynchronous.u / kUm, 2);
    EXPECT_TRUE(std::isnan(v.synchronous.u)) << "nothing is known of the contour";
  }
  EXPECT_NEAR(sum_value / kTests, kD2, 4.0 * kD3 / std::sqrt(kTests));
  EXPECT_NEAR(std::sqrt(sum_u2 / kTests), kD3, 0.05) << "as the mean of s^2 is that of the scatter";
}

TEST(ErrorMotion, ThreeAnglesAreTheLeast) {
  EXPECT_TRUE(std::isnan(EvaluateErrorMotion(Motion(Eigen::ArrayXd::Zero(2)), PlotCentre::kLeastSquares).synchronous.value));
  ErrorMotion motion = Motion(Eigen::ArrayXd::Zero(5));
  motion.contour[1] = kNaN;
  EXPECT_THROW(EvaluateErrorMotion(motion, PlotCentre::kLeastSquares), std::logic_error);
}

TEST(WidestRange, OfOneSampleHasTheConstantsOfControlCharts) {
  for (const auto& [size, d2, d3] : {std::tuple{2, 1.128, 0.853}, {3, 1.693, 0.888}, {5, 2.326, 0.864},
                                     {10, 3.078, 0.797}, {25, 3.931, 0.708}}) {
    const WidestRange range = WidestOf({{2.0, size}});
    EXPECT_NEAR(range.mean, 2.0 * d2, 2.0 * 0.001) << size << ": tables have three digits";
    EXPECT_NEAR(range.deviation, 2.0 * d3, 2.0 * 0.001) << size;
  }
}

TEST(WidestRange, OfTwoPairsIsThatOfTheLargerOfTwoHalfNormalNumbers) {
  // max(|a|, |b|) = (|a + b| + |a - b|) / 2, whose terms are independent; the range of a pair is sqrt(2) |a|.
  const WidestRange widest = WidestOf({{1.0, 2}, {1.0, 2}});
  EXPECT_NEAR(widest.mean, std::sqrt(2.0) * 2.0 / std::sqrt(std::numbers::pi), 1e-3);
  EXPECT_NEAR(widest.deviation, std::sqrt(2.0 * (1.0 - 2.0 / std::numbers::pi)), 1e-3);
}

TEST(WidestRange, OfSamplesOfManyScalesAndSizesIsWhatDrawsShow) {
  const std::vector<NormalSample> samples = {{1.0, 4}, {1.3, 3}, {0.2, 9}, {0.0, 5}, {1.1, 4}, {0.9, 7}};
  constexpr int kDraws = 20000;
  Stream normal(5, "test.ranges");
  double sum = 0.0, squares = 0.0;
  for (int d = 0; d < kDraws; ++d) {
    double widest = 0.0;
    for (const NormalSample& s : samples) {
      double most = -1e9, least = 1e9;
      for (int k = 0; k < s.size; ++k) {
        const double drawn = s.deviation * normal.Normal();
        most = std::max(most, drawn);
        least = std::min(least, drawn);
      }
      widest = std::max(widest, most - least);
    }
    sum += widest;
    squares += widest * widest;
  }
  const double mean = sum / kDraws, deviation = std::sqrt(squares / kDraws - mean * mean);
  const WidestRange widest = WidestOf(samples);
  EXPECT_NEAR(widest.mean, mean, 4.0 * deviation / std::sqrt(kDraws));
  EXPECT_NEAR(widest.deviation, deviation, 4.0 * deviation / std::sqrt(2.0 * kDraws));
}

TEST(WidestRange, OfNoScatterIsNone) {
  EXPECT_EQ(WidestOf({{0.0, 3}}).mean, 0.0);
  EXPECT_EQ(WidestOf({{0.0, 3}}).deviation, 0.0);
  EXPECT_THROW(WidestOf({{1.0, 1}}), std::logic_error);
  EXPECT_THROW(WidestOf({}), std::logic_error);
}

}  // namespace
}  // namespace twinbench::separate
