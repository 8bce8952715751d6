#include "mechanics/chain.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/mechanics/test_units.h"
#include "tests/support/oracle_poses.h"

namespace twinbench::mechanics {
namespace {

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
