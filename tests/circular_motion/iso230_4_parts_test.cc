#include <gtest/gtest.h>

#include <cmath>

#include "twin/benches/circular_motion/estimators/iso230_4.h"
#include "twin/core/units.h"

/// What the uncertainties of ISO 230-4 are made of, against sums by hand.
namespace twinbench::separate::circular {
namespace {

using units::um;
constexpr double kRounding = 1e-12;
constexpr int kPoints = 8, kHighest = 1, kLowest = 6;

/// One unknown that makes the radius larger by as much, known to 0.2 um: a quarter of the variance is left over beyond what is stated, another
/// quarter the machine's.
SharedUncertainty OfTheLength() {
  const double variance = 0.04 * um * um;
  SharedUncertainty shared;
  shared.cov = Eigen::MatrixXd::Constant(1, 1, variance);
  shared.hidden = Eigen::MatrixXd(1, 0);
  shared.typical = Eigen::VectorXd::Ones(1);
  shared.of_machine = 0.25 * shared.cov;
  shared.of_steps = 0.0 * shared.cov;
  shared.excess = 0.25;
  return shared;
}

/// A circle with one reading far out (u 0.3 um, half of it the machine's, a tenth the quanta's) and one far in (0.4 um; a fifth, none).
/// @param beyond_um  Of the one far out.
CirclePath Circle(int direction, double beyond_um = 0.0) {
  CirclePath path{0, direction > 0 ? 0 : 1, direction, true, 0.1, 0.01, {}};
  for (int i = 0; i < kPoints; ++i) {
    PathPoint& point = path.points.emplace_back();
    point.commanded_rad = units::turn * i / kPoints;
    const Eigen::Vector2d outwards(std::cos(point.commanded_rad), std::sin(point.commanded_rad));
    const double radial_m = um * (i == kHighest ? 5.0 + beyond_um : i == kLowest ? -7.0 : 0.0);
    point.d_m = radial_m * outwards;
    point.slope = outwards;
    point.u_own_m = um * Eigen::Vector2d::Constant(i == kHighest ? 0.3 : 0.4);
    point.of_machine.setConstant(i == kHighest ? 0.5 : 0.2);
    point.of_steps.setConstant(i == kHighest ? 0.1 : 0.0);
  }
  return path;
}

void ExpectParts(const Iso230_4Value& value, double variance_um2, double machine_um2, double steps_um2) {
  EXPECT_NEAR(std::pow(value.u_m / um, 2), variance_um2, kRounding);
  EXPECT_NEAR(value.repeatability, machine_um2 / variance_um2, kRounding);
  EXPECT_NEAR(value.quantisation, steps_um2 / variance_um2, kRounding);
  EXPECT_EQ(value.model, 0.0);
}

TEST(CircularDeviationParts, AreThoseOfTheReadingsAndOfWhatTheyShare) {
  const std::vector<Iso230_4> found = CircularDeviations({Circle(1), Circle(-1, 1.0)}, OfTheLength());
  ASSERT_EQ(found.size(), 1U);
  const double high = 0.09, high_machine = 0.045, high_steps = 0.009, low = 0.16, low_machine = 0.032;
  const double shared = 0.04, shared_machine = 0.5 * shared;
  ExpectParts(found[0].G_ccw, high + low, high_machine + low_machine, high_steps);
  ExpectParts(found[0].Fmax_ccw, high + shared, high_machine + shared_machine, high_steps);
  ExpectParts(found[0].Fmin_ccw, low + shared, low_machine + shared_machine, 0.0);
  ExpectParts(found[0].H, 2.0 * high, 2.0 * high_machine, 2.0 * high_steps);
}

TEST(CircularDeviationParts, OfAMeanHaveTheOwnNoiseAveraged) {
  const Iso230_4Value d = CircularDeviations({Circle(1), Circle(-1)}, OfTheLength())[0].D;
  const double square = std::pow(1.0 / (2.0 * kPoints), 2), shared = 0.04;
  const double own = 2.0 * square * (0.09 + 7.0 * 0.16), own_machine = 2.0 * square * (0.045 + 7.0 * 0.032);
  ExpectParts(d, own + shared, own_machine + 0.5 * shared, 2.0 * square * 0.009);
}

}  // namespace
}  // namespace twinbench::separate::circular
