#include "mechanics/sag.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/mechanics/eccentric_stack.h"
#include "tests/mechanics/test_units.h"

namespace twinbench::mechanics {
namespace {

double Tilt(const Vector12& q, int table) {
  return q.segment<2>(kPerTable * table + 3).norm();
}

TEST(StaticDeflection, FollowsTheFirstOrderFormula) {
  const Vector12 q = StaticDeflection(EccentricStack(), 0.3, -1.0);
  const double moment_Nm = 1.5 * 9.81 * 0.040;
  // m g r/k = 0.202 and 0.486 arcsec; the deflected masses add their leaning weight, about 1e-4 + 1e-4 of it.
  EXPECT_NEAR(Tilt(q, 0) / kArcsec, moment_Nm / 0.60e6 / kArcsec, 6e-4);
  EXPECT_NEAR(Tilt(q, 1) / kArcsec, moment_Nm / 0.25e6 / kArcsec, 6e-4);
  EXPECT_NEAR(Tilt(q, 0) / kArcsec, 0.202, 1e-3);
  EXPECT_NEAR(Tilt(q, 1) / kArcsec, 0.486, 1e-3);
  EXPECT_NEAR(q[2], -1.5 * 9.81 / 200e6, 1e-12);  // the payload's weight; the rest is preloaded
  EXPECT_NEAR(q[8], -1.5 * 9.81 / 120e6, 1e-12);
}

TEST(StaticDeflection, LeansTowardsThePayloadAndIsExactlyZeroForAStackThatIsOnlyItself) {
  StackParameters p = EccentricStack();
  p.payload.azimuth_rad = 0.5 * kPi;  // on +y: weight turns about +x, top comes down towards +y
  const Vector12 q = StaticDeflection(p, 0.0, 0.0);
  EXPECT_LT(q[3], 0.0);
  EXPECT_NEAR(q[4], 0.0, 1e-18);
  EXPECT_TRUE(SagIsConstant(StackParameters{}));
  EXPECT_EQ(StaticDeflection({}, 0.0, 0.0).cwiseAbs().maxCoeff(), 0.0);
}

TEST(StaticDeflection, CounterRotationKeepsTheTiltAndASingleTableTurnsIt) {
  const StackParameters p = EccentricStack();
  const Chain chain(p.geometry);
  const auto normal = [&](double target_rad, double reference_rad) {
    const Vector12 q = StaticDeflection(p, target_rad, reference_rad);
    ChainState state;
    state.target_rad = target_rad;
    state.reference_rad = reference_rad;
    state.target_bearing = BearingOf(q, 0);
    state.reference_bearing = BearingOf(q, 1);
    return Vector3(chain.ReferenceRotorPose(state).linear().col(2));
  };
  const Vector3 start = normal(0.0, 0.0);
  double counter = 0.0;
  double single = 0.0;
  for (int i = 1; i < 36; ++i) {
    const double a = 10.0 * i * kDegree;
    counter = std::max(counter, (normal(a, -a) - start).norm());
    single = std::max(single, (normal(0.0, a) - start).norm());
  }
  EXPECT_LT(counter, 6e-4 * kArcsec);
  // Half a turn of the reference swings the tilt from one side to the other: twice 0.202 + 0.486 arcsec.
  EXPECT_NEAR(single / kArcsec, 2.0 * (0.2023 + 0.4856), 2e-3);
}

TEST(WeightGradient, IsTheSlopeOfTheWeightsEnergyInTheChain) {
  StackParameters p = EccentricStack();
  p.geometry.centring_m = {1e-3, -2e-3};
  p.geometry.mount_tilt_rad = {1e-2, 2e-2};
  p.geometry.reseat_rad = 0.4;
  p.payload.azimuth_rad = 0.8;
  Vector12 q;
  q << 1e-3, -2e-3, 3e-3, 1e-2, -2e-2, 0.5, 2e-3, 1e-3, -1e-3, -1e-2, 3e-2, -1.1;
  const Chain chain(p.geometry);
  const auto energy = [&](const Vector12& at) {
    ChainState s;
    s.target_rad = at[SpinIndex(0)];
    s.reference_rad = at[SpinIndex(1)];
    s.target_bearing = BearingOf(at, 0);
    s.reference_bearing = BearingOf(at, 1);
    const Pose X_LT = chain.TargetRotorPose(s);
    const Pose X_LR = chain.ReferenceRotorPose(s);
    Pose X_TS = Pose::Identity();
    X_TS.linear() = (Eigen::AngleAxisd(2e-2, Vector3::UnitY()) * Eigen::AngleAxisd(1e-2, Vector3::UnitX()) *
                     Eigen::AngleAxisd(0.4, Vector3::UnitZ()))
                        .toRotationMatrix();
    X_TS.translation() << 1e-3, -2e-3, 0.08;
    const Vector3 p_RP(0.04 * std::cos(0.8), 0.04 * std::sin(0.8), 0.05);
    return 9.81 * (12.0 * X_LT.translation().z() + 9.0 * (X_LT * X_TS * Vector3(0, 0, -0.03)).z() +
                   6.0 * X_LR.translation().z() + 1.5 * (X_LR * p_RP).z());
  };
  const Vector12 slope = WeightGradient(p, q);
  for (int i = 0; i < kCoordinates; ++i) {
    const Vector12 h = 1e-5 * Vector12::Unit(i);
    // Central difference: energy 30 J rounds to 4e-15 J over 2e-5; third derivatives 30 x 1e-10/6
    EXPECT_NEAR(slope[i], (energy(q + h) - energy(q - h)) / 2e-5, 1e-8) << "coordinate " << i;
  }
}

}  // namespace
}  // namespace twinbench::mechanics
