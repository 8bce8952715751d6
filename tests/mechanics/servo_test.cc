#include "mechanics/adaptive_stack.h"
#include "tests/mechanics/plant_runs.h"

namespace twinbench::mechanics {
namespace {

TEST(Servo, IntegralStopsWhileTheTorqueIsAtItsLimit) {
  Servo servo({1.0, 0.0, 100.0}, 1e-3, 2.0);
  for (int i = 0; i < 1000; ++i) EXPECT_EQ(servo.Torque(5.0, 0.0, 0.0), 2.0);
  EXPECT_EQ(servo.integral_rad_s(), 0.0);
  servo.Torque(0.5, 0.0, 0.0);
  EXPECT_DOUBLE_EQ(servo.integral_rad_s(), 0.5e-3);
}

TEST(LuGreFriction, SlipsAtTheCoulombTorqueAndSticksLikeASpring) {
  FrictionParameters p{.coulomb_Nm = 0.2};
  LuGreFriction slipping(p, 0.1);
  double torque = 0.0;
  for (int i = 0; i < 1000; ++i) torque = slipping.Torque(0.5, 1e-3);
  EXPECT_NEAR(torque, -0.2, 1e-12);  // 500 Stribeck speeds, 10 000 presliding lengths: fully slipped

  p.bristle_damping_ratio = 0.0;
  LuGreFriction sticking(p, 0.1);
  // 1 nrad bends the bristles by 1 nrad of 50 urad: torque = stiffness x bend to 1/50 000.
  EXPECT_NEAR(sticking.Torque(1e-6, 1e-3), -0.2 / 50e-6 * 1e-9, 1e-4 * 4e-6);
}

TEST(LuGreFriction, IsStableForStepsFarLongerThanItsBristles) {
  FrictionParameters p{.coulomb_Nm = 0.5};
  LuGreFriction friction(p, 0.1);
  // One step slides 2000 presliding lengths. The bristle damping acts while they bend, in the first step only.
  friction.Torque(1.0, 0.1);
  EXPECT_NEAR(friction.Torque(1.0, 0.1), -0.5, 1e-9);
  friction.Torque(-1.0, 0.1);
  EXPECT_NEAR(friction.Torque(-1.0, 0.1), 0.5, 1e-9);
}

/// Speed and acceleration are the derivatives. Central differences: h^2/6 times a third derivative below
/// 60 travel/T^3 = 110, plus rounding 1e-15/h.
void ExpectDerivatives(const QuinticProfile& profile, const std::vector<double>& times_s) {
  const double h = 1e-6;
  for (const double t : times_s) {
    const ProfilePoint before = profile.At(t - h), after = profile.At(t + h);
    EXPECT_NEAR(profile.At(t).velocity_rad_s, (after.position_rad - before.position_rad) / (2.0 * h), 1e-8);
    EXPECT_NEAR(profile.At(t).acceleration_rad_s2, (after.velocity_rad_s - before.velocity_rad_s) / (2.0 * h),
                1e-6);
  }
}

TEST(QuinticProfile, IsThePolynomialOfFifthDegreeWithItsDerivatives) {
  const QuinticProfile profile(0.1, -0.3, 0.6);
  for (double s = 0.0; s <= 1.0; s += 0.05)  // whose speed and acceleration vanish at both ends
    EXPECT_NEAR(profile.At(0.6 * s).position_rad, 0.1 - 0.4 * s * s * s * (10.0 - 15.0 * s + 6.0 * s * s), 1e-15);
  EXPECT_EQ(profile.At(-1.0).position_rad, 0.1);  // rests before it and behind it
  EXPECT_EQ(profile.At(0.6).position_rad, -0.3);
  EXPECT_EQ(profile.At(9.0).velocity_rad_s, 0.0);
  ExpectDerivatives(profile, {0.05, 0.2, 0.3, 0.55});
  // The peak of the speed and, by 10 / sqrt(3), that of the acceleration.
  EXPECT_NEAR(profile.At(0.3).velocity_rad_s, 15.0 / 8.0 * -0.4 / 0.6, 1e-14);
  const double steepest_s = 0.6 * (0.5 - std::sqrt(1.0 / 12.0));
  EXPECT_NEAR(profile.At(steepest_s).acceleration_rad_s2, 10.0 / std::sqrt(3.0) * -0.4 / 0.36, 1e-13);
}

TEST(QuinticProfile, TakesAMotionUpWithItsSpeedAndBendAndBringsItToRest) {
  const QuinticProfile move(0.2, 2.0, 0.5);
  const ProfilePoint cut = move.At(0.2);
  const QuinticProfile stop(cut, cut.position_rad + 0.1, 0.3);
  EXPECT_FALSE(stop.from_rest());
  const ProfilePoint first = stop.At(0.0), last = stop.At(0.3);
  EXPECT_DOUBLE_EQ(first.position_rad, cut.position_rad);
  EXPECT_DOUBLE_EQ(first.velocity_rad_s, cut.velocity_rad_s);
  EXPECT_DOUBLE_EQ(first.acceleration_rad_s2, cut.acceleration_rad_s2);
  EXPECT_EQ(last.position_rad, cut.position_rad + 0.1);
  // Just before its end it is as good as there: speed and bend vanish with the square and the first power of what
  // is left, which is a millionth of the duration.
  EXPECT_NEAR(stop.At(0.3 * (1.0 - 1e-6)).velocity_rad_s, 0.0, 1e-9);
  EXPECT_NEAR(stop.At(0.3 * (1.0 - 1e-6)).acceleration_rad_s2, 0.0, 1e-2);
  ExpectDerivatives(stop, {0.05, 0.15, 0.25});
}

TEST(QuinticProfile, RefusesADurationThatIsNotPositive) {
  for (const double duration_s : {0.0, -1.0})
    EXPECT_THROW(QuinticProfile(0.0, 1.0, duration_s), std::invalid_argument);
  EXPECT_THROW(QuinticProfile(0.0, std::nan(""), 1.0), std::invalid_argument);
}

TEST(MoveResponse, ScaledAndAddedIsTheResponseToTheMove) {
  const StackParameters p = EccentricStack();
  const LinearModel model(p);
  const MoveResponse response(p, model, 0.2, 0.1);
  LinearStack stack(p, model);
  const double t = 10.0 * kDegree, r = -7.0 * kDegree;
  const MoveResponse::Shapes shapes = (MoveResponse::Shapes() << t, r, t * t, t * r, r * r).finished();
  Eigen::Vector2d peak = Eigen::Vector2d::Zero();
  for (int i = 0; i < response.size(); ++i) {
    const MoveResponse::Row row = response.At(i, shapes);
    // Same equations in another order of summation: rounding of 1e-5 rad and 1e-2 rad/s
    ASSERT_LT((row.head<kCoordinates>() - stack.state().head<kCoordinates>()).cwiseAbs().maxCoeff(), 1e-16);
    ASSERT_DOUBLE_EQ(row[SpinIndex(1)], response.At(i, shapes, SpinIndex(1)));
    PeriodCommand command;
    const double h = p.servo_period_s;
    const QuinticProfile target(0.0, t, 0.2), reference(0.0, r, 0.2);
    command.Set(0, target.At(i * h), target.At((i + 1) * h), h);
    command.Set(1, reference.At(i * h), reference.At((i + 1) * h), h);
    const double vt = target.At((i + 0.5) * h).velocity_rad_s, vr = reference.At((i + 0.5) * h).velocity_rad_s;
    command.speed_products << vt * vt, vt * vr, vr * vr;
    stack.Step(command);
    peak = peak.cwiseMax(stack.torque_Nm().cwiseAbs());
  }
  const Eigen::Vector2d bound = response.TorqueBound_Nm(shapes);
  EXPECT_GE(bound[0], peak[0]);
  EXPECT_GE(bound[1], peak[1]);
  EXPECT_LT(bound[0], 2.0 * peak[0]);
}

/// Both tables, then the reference alone, each time followed while they move, and for as long behind the arrival.
std::pair<Difference, Difference> FromFineSteps(const StackParameters& p) {
  Both both{MakePlant(Fidelity::kBullet, p), MakePlant(Fidelity::kBullet, Fine(p, 125e-6))};
  Difference moving, arrived;
  for (int move = 1; move <= 2; ++move) {
    if (move == 1) both.Send(Axis::kTarget, kTenDegrees);
    both.Send(Axis::kReference, -move * kTenDegrees);
    for (Difference* difference : {&moving, &arrived}) both.GoOn(600, 1e-3, *difference);
  }
  return {moving, arrived};
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
  Both both{MakePlant(Fidelity::kBullet, p), MakePlant(Fidelity::kBullet, Fine(p, p.step_s))};
  both.Send(Axis::kTarget, kTenDegrees, 0.3);
  both.GoOn(1, 2.3);  // the slow pole of 30 Hz, 81 / s, leaves e^-160
  const Difference& apart = both.difference;
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
