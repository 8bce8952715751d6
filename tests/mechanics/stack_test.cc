#include "mechanics/stack.h"

#include <Eigen/Dense>

#include "mechanics/sag.h"
#include "tests/mechanics/plant_runs.h"
#include "twin/core/linear_algebra.h"

namespace twinbench::mechanics {
namespace {

Vector12 Somewhere() {
  Vector12 q;
  q << 1e-6, -2e-6, 3e-6, 4e-6, -5e-6, 1.2, -2e-6, 1e-6, -4e-6, 2e-6, 6e-6, -2.9;
  return q;
}

double AngleBetween(const Pose& a, const Pose& b) {
  const Matrix3 d = a.linear().transpose() * b.linear();
  return 0.5 * Vector3(d(2, 1) - d(1, 2), d(0, 2) - d(2, 0), d(1, 0) - d(0, 1)).norm();
}

TEST(StackDynamics, BulletPutsItsRotorsWhereTheChainDoes) {
  const StackParameters p = CrookedStack();
  StackDynamics dynamics(p);
  for (int i = 0; i < 36; ++i) {
    Vector12 q = Somewhere();
    q[SpinIndex(0)] = 10.0 * i * kDegree;
    q[SpinIndex(1)] = -10.0 * i * kDegree;
    ChainState state{.target_rad = q[SpinIndex(0)], .reference_rad = q[SpinIndex(1)],
                     .target_bearing = BearingOf(q, 0), .reference_bearing = BearingOf(q, 1)};
    const Chain chain(p.geometry);
    for (const auto& [table, expected] :
         {std::pair(0, chain.TargetRotorPose(state)), {1, chain.ReferenceRotorPose(state)}}) {
      const Pose found = dynamics.BulletRotorPose(q, table);
      // Two ways to multiply a dozen rotations in double: 1e-15 rad = 2e-10 arcsec.
      EXPECT_LT(AngleBetween(found, expected), 1e-9 * kArcsec) << table;
      EXPECT_LT((found.translation() - expected.translation()).norm(), 1e-15) << table;
    }
  }
}

// Bullet leaves the accelerations in scratch memory; another release could place them elsewhere.
TEST(StackDynamics, ReadsTheAccelerationsFromTheRightPlace) {
  StackDynamics dynamics(CrookedStack());
  const Vector12 q = Somewhere();
  const Vector12 rest = Vector12::Zero();
  const Matrix12 inverse = dynamics.InverseMass(q);  // by another public function
  for (int i = 0; i < kCoordinates; ++i) {
    const Vector12 a = dynamics.AccelerateFreely(q, rest, Vector12::Unit(i));
    // Entries of the inverse reach 100; two algorithms in double
    EXPECT_LT((a - inverse.col(i)).cwiseAbs().maxCoeff(), 1e-11) << "coordinate " << i;
  }
}

TEST(StackDynamics, MassMatrixHasTheSpinInertiaOfTheBodies) {
  const StackParameters p = CrookedStack();
  StackDynamics dynamics(p);
  StackParameters centred = p;
  centred.geometry.centring_m.setZero();
  centred.geometry.mount_tilt_rad.setZero();
  const Matrix12 mass = StackDynamics(centred).InverseMass(Vector12::Zero()).inverse();
  const Eigen::Matrix2d expected = SpinInertia(p);
  for (int a = 0; a < 2; ++a) {
    // Inverting a matrix of condition 1e4 twice
    for (int b = 0; b < 2; ++b) EXPECT_NEAR(mass(SpinIndex(a), SpinIndex(b)), expected(a, b), 1e-12);
  }
  const double total_kg = 12.0 + 9.0 + 6.0 + 1.5;
  EXPECT_NEAR(mass(2, 2), total_kg, 1e-10);
  EXPECT_NEAR(mass(2, 8), 7.5, 1e-10);  // both axial bearings carry the reference's rotor and payload
}

TEST(StackDynamics, RestsWhereTheEnergyIsLeast) {
  const StackParameters p = CrookedStack();
  StackDynamics dynamics(p);
  const Vector12 rest = Vector12::Zero();
  const Vector12 k = BearingStiffness(p);
  for (int i = 0; i < 36; i += 5) {
    const Vector12 eigen = StaticDeflection(p, 10.0 * i * kDegree, -10.0 * i * kDegree);
    Vector12 q = Vector12::Zero();
    q[SpinIndex(0)] = eigen[SpinIndex(0)];
    q[SpinIndex(1)] = eigen[SpinIndex(1)];
    for (int round = 0; round < 8; ++round) {  // follow Bullet's own generalised force until it vanishes
      const Vector12 force = dynamics.InverseMass(q).ldlt().solve(dynamics.Accelerate(q, rest, {0.0, 0.0}));
      for (int c = 0; c < kCoordinates; ++c) q[c] += k[c] > 0.0 ? force[c] / k[c] : 0.0;
    }
    for (int table = 0; table < 2; ++table) {
      const Vector12 difference = (q - eigen).cwiseAbs();
      // Asked: 1e-5 arcsec. Forces of 300 N leave rounding of 1e-13 N on springs of 1e8 N/m and 1e5 Nm/rad.
      EXPECT_LT(difference.segment<2>(kPerTable * table + 3).maxCoeff(), 1e-5 * kArcsec);
      EXPECT_LT(difference.segment<3>(kPerTable * table).maxCoeff(), 1e-15);
    }
  }
}

TEST(StackDynamics, KeepsItsEnergyWithoutDamping) {
  StackParameters p = CrookedStack();
  p.damping_ratio = 0.0;
  StackDynamics dynamics(p);
  const auto drift = [&](double step_s, double duration_s) {
    Vector12 q = StaticDeflection(p, 0.0, 0.0);
    Vector12 qd = Vector12::Zero();
    const double least = dynamics.Energy(q, qd);
    q[0] += 1e-6;
    q[10] += 2e-6;
    const double vibration = dynamics.Energy(q, qd) - least;  // 5e-5 J
    qd[SpinIndex(0)] = 0.1;                                   // while the rotors turn
    qd[SpinIndex(1)] = -0.2;
    const double start = dynamics.Energy(q, qd);
    double worst = 0.0;
    for (int i = 0; i * step_s < duration_s; ++i) {
      dynamics.Step(step_s, {0.0, 0.0}, q, qd);
      if (i % 7 == 0) worst = std::max(worst, std::abs(dynamics.Energy(q, qd) - start) / vibration);
    }
    return worst;
  };
  // RK4 loses (omega h)^6/72 a step: halving the step gains 32.
  const double runge_kutta = drift(100e-6, 0.1);
  EXPECT_LT(runge_kutta, 0.02);
  EXPECT_LT(drift(50e-6, 0.1), runge_kutta / 16.0);
}

TEST(StackDynamics, DampingOnlyTakesEnergy) {
  const StackParameters p = CrookedStack();
  StackDynamics dynamics(p);
  Vector12 q = StaticDeflection(p, 0.0, 0.0);
  const double least = dynamics.Energy(q, Vector12::Zero());
  q[0] += 1e-6;
  q[9] += 1e-6;
  Vector12 qd = Vector12::Zero();
  double before = dynamics.Energy(q, qd) - least;
  ASSERT_GT(before, 0.0);
  for (int i = 0; i < 20; ++i) {
    for (int k = 0; k < 40; ++k) dynamics.Step(250e-6, {0.0, 0.0}, q, qd);
    const double after = dynamics.Energy(q, qd) - least;
    // The slowest mode, 150 Hz at about 3 %, loses 1 - exp(-2 x 0.03 x 942 x 0.01) = 40 % in 10 ms. Below 1e-11 J
    // the difference of energies is rounding and the rotors' slow swing about their axes.
    EXPECT_LT(after, std::max(before, 1e-11));
    before = after;
  }
}

TEST(StackDynamics, LowestAndHighestFrequencyAreThoseOfTheEigenvalueSolver) {
  const StackParameters p = CrookedStack();
  StackDynamics dynamics(p);
  const Vector12 root = BearingStiffness(p).cwiseSqrt();
  const Eigen::VectorXd squared_rad2_s2 =
      EigenvaluesOfSymmetric(root.asDiagonal() * dynamics.InverseMass(Vector12::Zero()) * root.asDiagonal());
  EXPECT_NEAR(LowestFrequency(dynamics), std::sqrt(squared_rad2_s2[2]), 1e-6);  // behind the two rotors; a part in 1e9
  EXPECT_NEAR(HighestFrequency(dynamics), std::sqrt(squared_rad2_s2[11]), 1e-5);
}

TEST(StackDynamics, SubStepsDivideThePeriodAndHoldTheStiffestMode) {
  StackParameters p;
  StackDynamics dynamics(p);
  EXPECT_GT(HighestFrequency(dynamics), 2.0 * kPi * 400.0);  // modes of an air-bearing stack
  EXPECT_LT(HighestFrequency(dynamics), 2.0 / 250e-6);       // so that 250 us suffices
  EXPECT_EQ(SubSteps(dynamics), 2);
  for (TableParameters& table : p.table) {
    table.axial_stiffness_N_m *= 16.0;
    table.radial_stiffness_N_m *= 16.0;
    table.tilt_stiffness_Nm_rad *= 16.0;
  }
  StackDynamics stiff(p);
  EXPECT_GT(SubSteps(stiff), 2);
  EXPECT_GE(SubSteps(stiff), 0.5 * p.servo_period_s * HighestFrequency(stiff));
}

TEST(StackParameters, RefusesBodiesWithoutMassAndSpringsWithoutStiffness) {
  StackParameters p;
  p.table[0].rotor.mass_kg = 0.0;
  EXPECT_THROW(StackDynamics{p}, std::invalid_argument);
  p = {};
  p.table[1].tilt_stiffness_Nm_rad = std::nan("");
  EXPECT_THROW(StackDynamics{p}, std::invalid_argument);
}

}  // namespace
}  // namespace twinbench::mechanics
