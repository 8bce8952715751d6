#include "twin/benches/rotary_4dof/estimators/chain.h"

#include <gtest/gtest.h>

#include "tests/separate/bench.h"
#include "tests/support/oracle_poses.h"
#include "twin/benches/rotary_4dof/estimators/grating_model.h"

namespace twinbench::separate {
namespace {

/// The oracle's poses give the reference's error in its base frame.
Vector6 ToRotorFrame(Vector6 e, double reference_rad) {
  const Eigen::Matrix2d turn = Eigen::Rotation2Dd(-reference_rad).toRotationMatrix();
  e.head<2>() = turn * e.head<2>();
  e.segment<2>(3) = turn * e.segment<2>(3);
  return e;
}

TEST(GratingPose, PutsTheSpotsWhereTheIndependentOraclePutsThem) {
  const auto poses = test::OraclePoses();
  ASSERT_GE(poses.size(), 100u);
  for (const test::OraclePose& pose : poses) {
    const bool reclamp = pose.is_reclamped;
    const Stop stop{pose.target_rad, pose.reference_rad, reclamp ? 0.0 : -pose.shift_rad,
                    reclamp ? pose.shift_rad : 0.0};
    PoseErrors errors;
    errors.target = Eigen::Map<const Vector6>(pose.target.data());
    errors.reference = ToRotorFrame(Eigen::Map<const Vector6>(pose.reference.data()), stop.reference_rad);
    const Vector4 spots_m = measure::PredictSpots(MotionOf(GratingPose(stop, errors, Bench())), Bench());
    // The oracle prints nine digits of a micrometre.
    EXPECT_LT((spots_m - Eigen::Map<const Vector4>(pose.spots_m.data())).cwiseAbs().maxCoeff(), 2e-15) << reclamp;
  }
}

/// Exact chain of one stop as a function of the columns of its first-order model.
Vector4 ChainAt(const Design& design, int setup, int target, const Eigen::VectorXd& x) {
  const bool reseat = design.setups[static_cast<std::size_t>(setup)].clamping == Clamping::kReseat;
  PoseErrors errors;
  errors.target << x[0], x[1], x[2], 0.0, kLengthUnit_m * x[3], 0.0;
  errors.reference << x[4], x[5], x[6], kLengthUnit_m * x[7], kLengthUnit_m * x[8], 0.0;
  errors.mount << x[10], x[11], x[9], 0.0, kLengthUnit_m * x[12], 0.0;
  if (reseat) errors.seat << x[13], x[14], 0.0, kLengthUnit_m * x[15], kLengthUnit_m * x[16], 0.0;
  const Stop stop = design.StopAt(design.setups[static_cast<std::size_t>(setup)], target);
  Vector4 motion = MotionOf(GratingPose(stop, errors, Bench()));
  motion[3] /= kLengthUnit_m;
  return motion;
}

TEST(ModelStop, IsTheDerivativeOfTheExactChain) {
  constexpr double kStep = 1e-5;
  for (const Clamping clamping : {Clamping::kReclamp, Clamping::kReseat}) {
    const Design design = MakeDesign(12, {0, 1, 5}, clamping, Bench());
    for (int setup = 0; setup < 3; ++setup) {
      for (int target = 0; target < 12; ++target) {
        const StopModel model = ModelStop(design, setup, target);
        for (int c = 0; c < model.columns; ++c) {
          const Eigen::VectorXd step = kStep * Eigen::VectorXd::Unit(StopModel::kMost, c);
          const Vector4 difference = ChainAt(design, setup, target, step) - ChainAt(design, setup, target, -step);
          // Third derivatives are of order 1: step^2 = 1e-10.
          EXPECT_LT((difference / (2 * kStep) - model.d.col(c)).cwiseAbs().maxCoeff(), 1e-9) << c;
        }
      }
    }
  }
}

}  // namespace
}  // namespace twinbench::separate
