#include <gtest/gtest.h>

#include <cmath>

#include "tests/diagnose/support/synthetic_run.h"
#include "twin/benches/encoder_comparison/diagnosis/signals.h"
#include "twin/core/units.h"
#include "twin/model/signals.h"
#include "twin/model/wave_grid.h"

namespace twinbench::diagnose::encoder {
namespace {

using units::deg, units::kPi;

/// Amplitude of sin(order p) in the error of clipped signals, by the midpoint rule over one period.
double ClippingOrder(double level, int order) {
  constexpr int kPoints = 200000;
  const Eigen::VectorXd p =
      (Eigen::VectorXd::LinSpaced(kPoints, 0.0, kPoints - 1.0).array() + 0.5) * 2.0 * kPi / kPoints;
  return 2.0 / kPoints * ClippingError_rad(p, level).dot((order * p.array()).sin().matrix());
}

/// The same from the closed form of the error in the piece where only the cosine is cut off, |p| < arccos(level):
/// atan(sin p / level) - p, which the other seven pieces repeat; Simpson's rule.
double ClippingOrderByPieces(double level, int order) {
  const double edge = std::acos(level);
  constexpr int kSteps = 2000;
  double sum = 0.0;
  for (int i = 0; i <= kSteps; ++i) {
    const double p = edge * i / kSteps, weight = i == 0 || i == kSteps ? 1.0 : i % 2 == 1 ? 4.0 : 2.0;
    sum += weight * (std::atan(std::sin(p) / level) - p) * std::sin(order * p);
  }
  return 8.0 * sum * edge / kSteps / 3.0 / kPi;
}

TEST(ClippingError, HasOrders4And8And12InRatiosThatFollowFromTheLevel) {
  for (const double level : {0.98, 0.95, 0.9, 0.8}) {
    for (const int order : {4, 8, 12})
      EXPECT_NEAR(ClippingOrder(level, order), ClippingOrderByPieces(level, order), 1e-8) << level << " " << order;
    for (const int order : {1, 2, 3, 5, 6, 10}) EXPECT_NEAR(ClippingOrder(level, order), 0.0, 1e-12) << order;
  }
  // Shallow clipping errs in narrow pairs of opposite blips, whose orders grow with their number: 8 / 4.
  EXPECT_NEAR(ClippingOrder(0.9999, 8) / ClippingOrder(0.9999, 4), 2.0, 0.05);
}

SignalContext Steps(const std::vector<double>& angle_deg, const std::vector<int>& direction) {
  const auto n = std::ssize(angle_deg);
  Schedule s = PlainSchedule(static_cast<int>(n));
  s.time_s = Eigen::VectorXd::LinSpaced(n, 0.0, static_cast<double>(n - 1));
  s.reference_rad = Eigen::Map<const Eigen::VectorXd>(angle_deg.data(), n) * deg;
  s.direction = direction;
  return ContextOf(s, s.reference_rad, {});
}

TEST(WaveGrid, IsTheWaveOfEachGridPoint) {
  const Eigen::VectorXd phase = Eigen::VectorXd::LinSpaced(50, -3.0, 125.0);  // twenty turns
  constexpr int kCount = 5972;
  const model::WaveGrid grid(phase, 0.3, 0.01, kCount);
  for (const int g : {0, 1, 77, 78, 79, 3000, kCount - 1})
    EXPECT_LT((grid.At(g) - model::Wave((0.3 + 0.01 * g) * phase)).cwiseAbs().maxCoeff(), 1e-11) << g;
  EXPECT_LT((model::WaveGrid(phase, 2.0, 1.0, 1).At(0) - model::Wave(2.0 * phase)).norm(), 1e-12);
}

TEST(Sense, IsThatOfTheLastMotionWhereItHoldsAtRest) {
  const SignalContext c = Steps({0, 1, 1, 0, 0}, {0, 1, 0, -1, 0});
  EXPECT_EQ(Sense(c, true), (Eigen::VectorXd(5) << 1, 1, 1, -1, -1).finished());
  EXPECT_EQ(Sense(c, false), (Eigen::VectorXd(5) << 0, 1, 0, -1, 0).finished());
}

TEST(Senses, AreThoseThatDifferOnTheSchedule) {
  const SignalContext stops = Steps({0, 1, 1, 0}, {1, 1, -1, -1});
  const auto senses = Senses(stops);
  ASSERT_EQ(senses.size(), 2u);
  EXPECT_EQ(senses[0], (Eigen::VectorXd(4) << 1, 1, -1, -1).finished());
  EXPECT_EQ(senses[1], (Eigen::VectorXd(4) << 1, 1, 1, -1).finished()) << "at the turning stop nothing has moved";
  EXPECT_EQ(Senses(Steps({0, 1, 2}, {1, 1, 1})).size(), 1u);
}

TEST(Travel, BeginsAnewWhereTheShaftWentBack) {
  SignalContext c = Steps({0, 10, 20, 10, 0, 0, -10}, {1, 1, 1, -1, -1, -1, -1});
  c.pass = {0, 0, 0, 1, 1, 2, 2};
  EXPECT_TRUE(
      TravelSinceReversal_rad(c).isApprox(deg * (Eigen::VectorXd(7) << 0, 10, 20, 0, 10, 10, 20).finished()))
      << "the third pass goes on where the second one ended";
  SignalContext returned = Steps({20, 10, 0, 20, 10}, {-1, -1, -1, -1, -1});
  EXPECT_TRUE(TravelSinceReversal_rad(returned).isApprox(deg * (Eigen::VectorXd(5) << 0, 10, 20, 0, 10).finished()))
      << "on the way back to 20 it was driven the other way";
}

TEST(Relaxation, GoesOverToTheSenseExponentially) {
  const SignalContext c = Steps({0, 20, 40, 20}, {1, 1, 1, -1});
  const Eigen::MatrixXd states = Relaxation(c, 20.0 * deg, 0.0);
  const double e = std::exp(-1.0);
  EXPECT_NEAR(states(1, 0), 1.0 - e, 1e-12);
  EXPECT_NEAR(states(2, 0), 1.0 - e * e, 1e-12);
  EXPECT_NEAR(states(3, 0), -1.0 + (1.0 - e * e + 1.0) * e, 1e-12);
  EXPECT_NEAR(states(3, 1), e * e * e, 1e-12) << "an unknown first state dies out with the way";
}

TEST(Relaxation, CountsTheRunUpToAStop) {
  const SignalContext c = Steps({0, 20}, {1, -1});  // beyond 20 by 5 and back by 5
  const Eigen::MatrixXd states = Relaxation(c, 20.0 * deg, 5.0 * deg);
  const double first = 1.0 - std::exp(-0.25);
  const double beyond = 1.0 + (first - 1.0) * std::exp(-1.25);
  EXPECT_NEAR(states(0, 0), first, 1e-12);
  EXPECT_NEAR(states(1, 0), -1.0 + (beyond + 1.0) * std::exp(-0.25), 1e-12);
}

}  // namespace
}  // namespace twinbench::diagnose::encoder
