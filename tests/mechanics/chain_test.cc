#include <gtest/gtest.h>

#include <cmath>

#include "mechanics/chain.h"
#include "mechanics/sag.h"
#include "tests/mechanics/eccentric_stack.h"
#include "tests/mechanics/test_units.h"
#include "tests/support/oracle_poses.h"

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

PoseError ErrorOf(const test::OracleError& e) {
  return {e[0], e[1], e[2], e[3], e[4], e[5]};
}

Pose GratingAt(const test::OraclePose& pose, ErrorFrame frame) {
  ChainGeometry geometry;
  (pose.is_reclamped ? geometry.clamp_rad : geometry.reseat_rad) = pose.is_reclamped ? pose.shift_rad : -pose.shift_rad;
  ChainState state;
  state.target_rad = pose.target_rad;
  state.reference_rad = pose.reference_rad;
  state.reference_frame = frame;
  state.target_error = ErrorOf(pose.target);
  state.reference_error = ErrorOf(pose.reference);
  return Chain(geometry).GratingPose(state);
}

/// Where an order meets its PSD: vector grating equation, then ray and plane. `side` is +1 for PSD A, -1 for B.
Eigen::Vector2d Spot(const Pose& X_LG, double side) {
  const Vector3 source(0.0, 0.2, 0.0);
  const Vector3 d(0.0, -1.0, 0.0);
  const Vector3 g = X_LG.linear().col(0);
  const Vector3 n = X_LG.linear().col(1);
  const Vector3 hit = source + d * n.dot(X_LG.translation() - source) / n.dot(d);
  const Vector3 across = d - d.dot(n) * n + side * 650e-9 * 600e3 * g;
  const Vector3 k = across + std::sqrt(1.0 - across.squaredNorm()) * n;
  const double sine = 0.39;
  const double cosine = std::sqrt(1.0 - sine * sine);
  const Vector3 normal(side * sine, cosine, 0.0);
  const Vector3 centre = 0.120 * normal;
  const Vector3 u(cosine, -side * sine, 0.0);
  const Vector3 spot = hit + k * normal.dot(centre - hit) / normal.dot(k) - centre;
  return {spot.dot(u), spot.z()};
}

/// On A and on B.
Eigen::Vector4d Spots(const Pose& X_LG) {
  return (Eigen::Vector4d() << Spot(X_LG, 1.0), Spot(X_LG, -1.0)).finished();
}

TEST(Chain, AgreesWithTheIndependentSpotsToANanometre) {
  int n_other = 0;
  for (const test::OraclePose& pose : test::OraclePoses()) {
    const Eigen::Vector4d spots_m = Spots(GratingAt(pose, ErrorFrame::kBase));
    // The file prints 1e-15 m; 1 nm is the agreement promised.
    EXPECT_LT((spots_m - Eigen::Map<const Eigen::Vector4d>(pose.spots_m.data())).cwiseAbs().maxCoeff(), 1e-9);
    n_other += (Spots(GratingAt(pose, ErrorFrame::kRotor)) - spots_m).head<2>().norm() > 1e-9;
  }
  EXPECT_GT(n_other, 250);  // the other reading of the reference's frame would be seen in nearly every row
}

TEST(Chain, EqualsTheProductOfItsFactorsForEveryInput) {
  ChainGeometry g;
  g.p_RG_m = Vector3(0.01, 0.03, 0.05);
  g.centring_m = {20e-6, -30e-6};
  g.mount_tilt_rad = {1e-4, -2e-4};
  g.reseat_rad = -0.7;
  g.clamp_rad = 0.3;
  ChainState s;
  s.target_rad = 1.1;
  s.reference_rad = -2.3;
  s.target_error = {1e-5, 2e-5, -3e-5, 1e-6, 2e-6, 3e-6};
  s.reference_error = {-2e-5, 1e-5, 4e-5, -3e-6, 1e-6, 2e-6};
  s.target_bearing = {1e-6, 2e-6, -3e-6, 2e-6, -5e-6};
  s.reference_bearing = {-2e-6, 1e-6, -1e-6, 3e-6, 1e-6};
  s.goniometer_yaw_rad = 1e-3;
  s.goniometer_tilt_rad = -2e-3;

  using Eigen::AngleAxisd;
  using Eigen::Translation3d;
  const Vector3 x = Vector3::UnitX();
  const Vector3 y = Vector3::UnitY();
  const Vector3 z = Vector3::UnitZ();
  const auto bearing = [&](const BearingPose& b) {
    return Translation3d(b.x_m, b.y_m, b.z_m) * AngleAxisd(b.rx_rad, x) * AngleAxisd(b.ry_rad, y);
  };
  const auto error = [&](const PoseError& e) {
    return Translation3d(e.dx_m, e.dy_m, e.dz_m) * AngleAxisd(e.ez_rad, z) * AngleAxisd(e.ey_rad, y) *
           AngleAxisd(e.ex_rad, x);
  };
  const Eigen::Rotation2Dd turn(s.reference_rad);
  PoseError base = s.reference_error;
  const Eigen::Vector2d tilt = turn * Eigen::Vector2d(base.ex_rad, base.ey_rad);
  const Eigen::Vector2d radial = turn * Eigen::Vector2d(base.dx_m, base.dy_m);
  base = {tilt.x(), tilt.y(), base.ez_rad, radial.x(), radial.y(), base.dz_m};
  const Eigen::Affine3d expected = Eigen::Affine3d(AngleAxisd(s.goniometer_yaw_rad, z)) *
                                   AngleAxisd(s.goniometer_tilt_rad, x) * Translation3d(-0.01, -0.03, -0.13) *
                                   bearing(s.target_bearing) * error(s.target_error) * AngleAxisd(s.target_rad, z) *
                                   Translation3d(20e-6, -30e-6, 0.08) * AngleAxisd(-2e-4, y) * AngleAxisd(1e-4, x) *
                                   AngleAxisd(-0.7, z) * bearing(s.reference_bearing) * error(base) *
                                   AngleAxisd(s.reference_rad, z) * AngleAxisd(-0.3, z) * Translation3d(g.p_RG_m);
  // Two orders of multiplying a dozen matrices of size one: 1e-15 each.
  EXPECT_LT((Chain(g).GratingPose(s).matrix() - expected.matrix()).norm(), 5e-15);
}

}  // namespace
}  // namespace twinbench::mechanics
