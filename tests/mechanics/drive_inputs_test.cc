#include "mechanics/base_response.h"
#include "mechanics/drive_loads.h"
#include "mechanics/servo.h"
#include "tests/mechanics/plant_runs.h"

namespace twinbench::mechanics {
namespace {

/// Sent there and at rest.
std::unique_ptr<Plant> Sent(Fidelity fidelity, const StackParameters& p, Axis axis, double to_rad) {
  auto plant = MakePlant(fidelity, p);
  plant->StartMove(axis, to_rad, 0.6);
  plant->AdvanceUntilSettled(5.0);
  plant->Advance(1.0);
  EXPECT_TRUE(plant->Settled()) << static_cast<int>(fidelity);
  return plant;
}

TEST(DriveLoads, CablesLeaveAFollowingErrorOfTheirSlopeByTheIntegralGain) {
  StackParameters p;
  p.table[0].cable = {0.5, 0.3, 40.0 * kDegree};
  const double inertia_kg_m2 = SpinInertia(p)(0, 0);
  const double integral_Nm_rad_s = ServoGains::For(inertia_kg_m2, p.table[0].servo_Hz).integral_Nm_rad_s;
  for (const Fidelity fidelity : kBodies) {
    const auto plant = MakePlant(fidelity, p);
    plant->StartMove(Axis::kTarget, 30.0 * kDegree, 20.0);
    plant->Advance(10.0);  // at 15 deg and full speed
    const double speed_rad_s = 1.875 * 30.0 * kDegree / 20.0;
    const double slope_Nm_rad = 0.5 + 0.3 * std::cos((15.0 - 40.0) * kDegree);
    const double lag_rad = slope_Nm_rad * speed_rad_s / integral_Nm_rad_s;
    // The torque changes over 20 s, the servo's slowest pole is 12 ms.
    EXPECT_NEAR((15.0 * kDegree - plant->State().target_rad) / lag_rad, 1.0, 0.01) << static_cast<int>(fidelity);
    EXPECT_GT(lag_rad, 0.02 * kArcsec);
    plant->AdvanceUntilSettled(30.0);
    plant->Advance(1.0);
    EXPECT_NEAR(plant->State().target_rad, 30.0 * kDegree,
                1e-4 * kArcsec);  // which the integral takes away at rest
  }
}

/// Work of both unbalances' forces as they stand, on the points where they act, by the poses of Chain.
double Work(const Chain& chain, const Vector12& deflection) {
  ChainState s{.target_rad = 0.7, .reference_rad = -0.2, .target_bearing = BearingOf(deflection, 0),
               .reference_bearing = BearingOf(deflection, 1)};
  const Vector3 at_target = chain.TargetRotorPose(s) * Vector3(0.0, 0.0, 0.01);
  const Vector3 at_reference = chain.ReferenceRotorPose(s) * Vector3(0.0, 0.0, 0.02);
  const double target_rad = 0.7 + 0.3, reference_rad = 0.7 - 0.4 - 0.2 + 1.1;
  return 0.03 * 9.0 * Vector3(std::cos(target_rad), std::sin(target_rad), 0.0).dot(at_target) +
         0.05 * 49.0 * Vector3(std::cos(reference_rad), std::sin(reference_rad), 0.0).dot(at_reference);
}

TEST(DriveLoads, UnbalancePullsAtEveryCoordinateThatMovesIt) {
  StackParameters p;
  p.geometry.reseat_rad = -0.4;
  p.table[0].rotor.height_m = 0.01;
  p.table[1].rotor.height_m = 0.02;
  p.table[0].unbalance = {0.03, 0.3};
  p.table[1].unbalance = {0.05, 1.1};
  const Chain chain(p.geometry);
  const Vector12 load = DriveLoads(p, {0.7, -0.2}, {3.0, 4.0});
  for (int i = 0; i < kCoordinates; ++i) {
    if (i % kPerTable == kSpin) continue;
    const Vector12 nudge = 1e-6 * Vector12::Unit(i);
    EXPECT_NEAR(load[i], (Work(chain, nudge) - Work(chain, -nudge)) / 2e-6, 1e-8) << i;
  }
  EXPECT_EQ(load[SpinIndex(0)], 0.0);
}

TEST(DriveLoads, UnbalanceDeflectsTheBearingWithTheSquareOfTheSpeed) {
  StackParameters p;
  p.table[0].unbalance = {0.06, 0.5};
  for (const Fidelity fidelity : kAll) {
    for (const double duration_s : {4.0, 8.0}) {
      const auto plant = MakePlant(fidelity, p);
      plant->StartMove(Axis::kTarget, 2.0 * kPi, duration_s);
      plant->Advance(0.5 * duration_s);
      const double speed_rad_s = 1.875 * 2.0 * kPi / duration_s;
      const double force_N = 0.06 * speed_rad_s * speed_rad_s;
      const BearingPose b = plant->State().target_bearing;
      // Half a turn: against the azimuth at the start. At 0.5 turns a second and modes above 200 Hz the answer is
      // static.
      const double deflection_m = force_N / p.table[0].radial_stiffness_N_m;
      EXPECT_NEAR(b.x_m / deflection_m, -std::cos(0.5), 0.01) << static_cast<int>(fidelity);
      EXPECT_NEAR(b.y_m / deflection_m, -std::sin(0.5), 0.01);
    }
  }
}

TEST(Scale, ItsSubdivisionErrorMakesTheRotorStandWrongByItself) {
  StackParameters p;
  p.table[0].scale.subdivision_rad = 0.5 * kArcsec;
  const double period_rad = 2.0 * kPi / p.table[0].scale.periods;
  for (const Fidelity fidelity : kAll) {
    for (const double share : {0.0, 0.25, 0.6}) {
      const double to_rad = (1000.0 + share) * period_rad;
      const auto plant = Sent(fidelity, p, Axis::kTarget, to_rad);
      const double wrong_rad = plant->State().target_rad - to_rad;
      // It stands at a with a + s sin(N a) = command.
      EXPECT_NEAR(wrong_rad, -0.5 * kArcsec * std::sin(2.0 * kPi * share + p.table[0].scale.periods * wrong_rad),
                  1e-3 * kArcsec)
          << static_cast<int>(fidelity) << " " << share;
      EXPECT_NEAR(plant->State().target_encoder_rad, to_rad, 1e-3 * kArcsec);
    }
  }
}

TEST(Scale, LeavesTheRotorFreeWithinHalfAStepOfItsResolution) {
  StackParameters p;
  p.table[1].scale.resolution_rad = 0.2 * kArcsec;
  for (const Fidelity fidelity : kBodies) {
    double furthest_rad = 0.0;
    for (int i = 1; i <= 5; ++i) {
      const double to_rad = 50000 * i * p.table[1].scale.resolution_rad;
      const StackState s = Sent(fidelity, p, Axis::kReference, to_rad)->State();
      EXPECT_NEAR(s.reference_encoder_rad, to_rad, 1e-12);
      EXPECT_LE(std::abs(s.reference_rad - to_rad), 0.1 * kArcsec + 1e-12);
      furthest_rad = std::max(furthest_rad, std::abs(s.reference_rad - to_rad));
    }
    EXPECT_GT(furthest_rad, 0.01 * kArcsec) << "nothing brings it to the middle";
  }
}

/// Largest speed of the target on a slow way, by the speed commanded.
double LargestSpeed(double static_ratio, Fidelity fidelity) {
  StackParameters p;
  p.table[0].friction = {
      .coulomb_Nm = 0.2, .static_ratio = static_ratio, .stribeck_rad_s = 1e-4, .presliding_rad = 5e-6};
  const auto plant = MakePlant(fidelity, p);
  constexpr double kDuration_s = 8.0, kSpeed_rad_s = 7e-5;
  plant->StartMove(Axis::kTarget, kSpeed_rad_s * kDuration_s / 1.875, kDuration_s);
  plant->Advance(0.4 * kDuration_s);
  double largest_rad_s = 0.0, before_rad = plant->State().target_rad;
  for (int k = 0; k < 3200; ++k) {  // the quickest fifth of the way
    plant->Advance(0.5e-3);
    const double now_rad = plant->State().target_rad;
    largest_rad_s = std::max(largest_rad_s, (now_rad - before_rad) / 0.5e-3);
    before_rad = now_rad;
  }
  return largest_rad_s / kSpeed_rad_s;
}

TEST(LuGreFriction, SticksAndSlipsOnASlowWayWhereBreakawayExceedsCoulomb) {
  for (const Fidelity fidelity : kBodies) {
    // A friction that falls with the speed by more than the controller damps makes it stick and slip; a constant
    // one does not.
    EXPECT_GT(LargestSpeed(1.5, fidelity), 3.0) << static_cast<int>(fidelity);
    EXPECT_LT(LargestSpeed(1.0, fidelity), 1.2) << static_cast<int>(fidelity);
  }
}

TEST(RespondToBase, GivesTheTwoMassesOneOverTheOtherTheirVerticalMotion) {
  const StackParameters p;
  const Vector12 d = BearingDamping(p);
  for (const double frequency_Hz : {5.0, 150.0, 430.0, 900.0}) {
    const std::complex<double> s(0.0, 2.0 * kPi * frequency_Hz);
    // m2 z2'' = -k2 (z2 - z1), m1 z1'' = k2 (z2 - z1) - k1 (z1 - zb), in the laboratory, base zb = 1 / s^2.
    const std::complex<double> k1 = 200e6 + s * d[2], k2 = 120e6 + s * d[8], zb = 1.0 / (s * s);
    const double m1 = 12.0 + 9.0, m2 = 6.0;
    const std::complex<double> z2_by_z1 = k2 / (m2 * s * s + k2);
    const std::complex<double> z1 = k1 * zb / (m1 * s * s + k1 + k2 * (1.0 - z2_by_z1));
    const ComplexResponse y = RespondToBase(p, frequency_Hz);
    EXPECT_LT(std::abs(y(2, 2) - (z1 - zb)), 1e-9 * std::abs(z1 - zb)) << frequency_Hz;
    EXPECT_LT(std::abs(y(8, 2) - z1 * (z2_by_z1 - 1.0)), 1e-9 * std::abs(z1)) << frequency_Hz;
  }
}

TEST(RespondToBase, IsTheStaticDeflectionBelowEveryMode) {
  const StackParameters p;
  const ComplexResponse y = RespondToBase(p, 0.5);
  // 1 m/s^2 on 27 kg above the target's bearing and 0.93 kg m of lever; the lowest mode, above 200 Hz, adds 1e-5.
  EXPECT_NEAR(y(0, 0).real(), -27.0 / 100e6, 1e-4 * 27.0 / 100e6);
  EXPECT_NEAR(y(4, 0).real(), -(9.0 * 0.05 + 6.0 * 0.08) / 0.60e6, 1e-4 * 0.93 / 0.60e6);
  EXPECT_NEAR(y(6, 0).real(), -6.0 / 60e6, 1e-4 * 6.0 / 60e6);
  EXPECT_NEAR(y(1, 1).real(), y(0, 0).real(), 1e-15);
  EXPECT_NEAR(y(3, 1).real(), -y(4, 0).real(), 1e-15);
}

TEST(RespondToBase, IsWhatBulletDoesUnderTheForceOfAShakenBase) {
  const StackParameters p;
  StackDynamics dynamics(p);
  const double frequency_Hz = 60.0, rate_rad_s = 2.0 * kPi * frequency_Hz;
  // Bullet's bodies in a frame that accelerates by a cos(w t) along x: as if the weight had a share -a cos(w t)
  // there. The force that does this to the coordinates is found from how Bullet accelerates when each is pushed
  // alone.
  const Matrix12 mass = dynamics.InverseMass(Vector12::Zero()).inverse();
  const Vector12 stiffness = BearingStiffness(p), damping = BearingDamping(p);
  Vector12 q = Vector12::Zero(), v = Vector12::Zero();
  constexpr double kStep_s = 20e-6, kBase_m_s2 = 1e-3;
  std::complex<double> answer = 0.0;
  const int period = static_cast<int>(std::lround(1.0 / (frequency_Hz * kStep_s)));
  const int steps = 60 * period;
  for (int i = 0; i < steps; ++i) {
    const double t_s = (i + 0.5) * kStep_s;
    q += 0.5 * kStep_s * v;
    const Vector12 force = -stiffness.cwiseProduct(q) - damping.cwiseProduct(v) -
                           kBase_m_s2 * std::cos(rate_rad_s * t_s) * mass.col(0);
    v += kStep_s * dynamics.AccelerateFreely(q, v, force);
    v[SpinIndex(0)] = v[SpinIndex(1)] = 0.0;
    q += 0.5 * kStep_s * v;
    if (i < steps - 10 * period) continue;  // after 0.8 s the start has fallen to e^-22
    answer += q[0] * std::polar(1.0, -rate_rad_s * (i + 1) * kStep_s) * 2.0 / (10.0 * period);
  }
  EXPECT_NEAR(std::abs(answer / kBase_m_s2 / RespondToBase(p, frequency_Hz)(0, 0) - 1.0), 0.0, 0.01);
}

}  // namespace
}  // namespace twinbench::mechanics
