#include "mechanics/adaptive_stack.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/mechanics/plant_runs.h"

namespace twinbench::mechanics {
namespace {

/// Both tables, then the reference alone, each time followed while they move, and for as long behind the arrival.
std::pair<Difference, Difference> FromFineSteps(StackParameters p) {
  const auto adaptive = MakePlant(Fidelity::kBullet, p);
  p.integrator = Integrator::kRungeKutta4;
  p.step_s = 125e-6;
  const auto fine = MakePlant(Fidelity::kBullet, p);
  Difference moving, arrived;
  for (int move = 1; move <= 2; ++move) {
    for (Plant* plant : {adaptive.get(), fine.get()}) {
      if (move == 1) plant->StartMove(Axis::kTarget, kTenDegrees, 0.6);
      plant->StartMove(Axis::kReference, -move * kTenDegrees, 0.6);
    }
    for (Difference* difference : {&moving, &arrived}) difference->GoOn(*adaptive, *fine, 600, 1e-3);
  }
  return {moving, arrived};
}

StackParameters CrookedStack() {
  StackParameters p = EccentricStack();
  p.payload.azimuth_rad = 0.6;
  p.geometry.reseat_rad = -0.7;
  p.geometry.centring_m << 30e-6, -20e-6;
  p.geometry.mount_tilt_rad << 100e-6, 150e-6;
  return p;
}

TEST(AdaptiveStack, GoesTheWayOfFineSteps) {
  for (const StackParameters& p : {StackParameters{}, CrookedStack()}) {
    const auto [moving, arrived] = FromFineSteps(p);
    // Asked of a reading: 1 nm and 0.001 arcsec. RK4 at 125 us misses some 1e-8 arcsec.
    EXPECT_LT(moving.position_m, 0.1e-9);
    EXPECT_LT(std::max(moving.yaw_rad, moving.tilt_rad), 1e-4 * kArcsec);
    EXPECT_LT(arrived.position_m, 0.01e-9);
    EXPECT_LT(std::max(arrived.yaw_rad, arrived.tilt_rad), 2e-5 * kArcsec);  // kMiss is 4e-6
  }
}

TEST(AdaptiveStack, RestsWhereTheMotionWouldHaveLedTo) {
  const StackParameters p = CrookedStack();
  const auto asked_late = MakePlant(Fidelity::kBullet, p);
  StackParameters fine_p = p;
  fine_p.integrator = Integrator::kLeapfrog;
  const auto fine = MakePlant(Fidelity::kBullet, fine_p);
  for (Plant* plant : {asked_late.get(), fine.get()}) {
    plant->StartMove(Axis::kTarget, kTenDegrees, 0.3);
    plant->Advance(2.3);  // the slow pole of 30 Hz, 81 / s, leaves e^-160
  }
  Difference apart;
  apart.Include(asked_late->State(), fine->State());
  EXPECT_LT(apart.position_m, 1e-13);
  EXPECT_LT(std::max(apart.yaw_rad, apart.tilt_rad), 1e-7 * kArcsec);  // rounding of 10 deg in 8000 steps
}

TEST(AdaptiveStack, LooksIntoAPeriodWithoutAStair) {
  for (const Fidelity fidelity : kBodies) {
    const auto plant = MakePlant(fidelity, CrookedStack());
    plant->StartMove(Axis::kReference, kTenDegrees, 0.1);
    plant->Advance(0.1);
    std::vector<double> x_m;
    for (int i = 0; i < 400; ++i) {
      plant->Advance(0.1e-3);
      x_m.push_back(plant->State().reference_bearing.x_m);
    }
    // Modes up to 825 Hz swing; a stair of 0.5 ms would repeat four values of five and jump at the fifth.
    double bend_m = 0.0, largest_m = 0.0;
    for (std::size_t i = 1; i + 1 < x_m.size(); ++i) {
      bend_m = std::max(bend_m, std::abs(x_m[i - 1] - 2.0 * x_m[i] + x_m[i + 1]));
      largest_m = std::max(largest_m, std::abs(x_m[i] - x_m.back()));
      EXPECT_NE(x_m[i], x_m[i - 1]);
    }
    const double most = 2.0 * kPi * 825.0 * 0.1e-3;  // a sine's second difference by its amplitude: (omega h)^2
    EXPECT_LT(bend_m, most * most * largest_m) << static_cast<int>(fidelity);
    EXPECT_GT(largest_m, 1e-10);
  }
}

TEST(AdaptiveStack, GivesTheSameBitsHoweverOftenItIsLookedAt) {
  for (const Fidelity fidelity : kAll) {
    std::vector<std::array<double, 14>> found;
    for (const int pieces : {1, 7, 5000}) {
      const auto plant = MakePlant(fidelity, CrookedStack());
      const auto pass = [&](double time_s) {
        for (int k = 0; k < pieces; ++k) {
          plant->Advance(time_s / pieces);
          plant->State();
        }
      };
      plant->StartMove(Axis::kTarget, kTenDegrees, 0.3);
      pass(0.35);
      plant->StartMove(Axis::kReference, kTenDegrees, 0.3);  // while the servo still rings
      pass(0.14);
      found.push_back(Numbers(plant->State()));
    }
    EXPECT_EQ(found[0], found[1]);
    EXPECT_EQ(found[0], found[2]);
  }
}

// Added up column by column, on every processor as Eigen does it here.
TEST(StackPropagator, StepsByTheBitsOfItsMatrices) {
  const StackPropagator propagator(CrookedStack());
  const StackPropagator::State from = StackPropagator::State::LinSpaced(-1e-6, 3e-6).array().sin();
  const Vector12 acceleration = Vector12::LinSpaced(0.3, -0.7).array().cos();
  for (int parts = 0; parts <= StackPropagator::kParts; ++parts) {
    const StackPropagator::State to = propagator.transition(parts) * from + propagator.drive(parts) * acceleration;
    EXPECT_EQ(propagator.Step(from, acceleration, parts), to) << parts;
  }
}

}  // namespace
}  // namespace twinbench::mechanics
