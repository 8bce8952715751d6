#include "mechanics/linear_model.h"

#include <gtest/gtest.h>

#include <cmath>

#include "mechanics/profile.h"
#include "tests/mechanics/eccentric_stack.h"
#include "tests/mechanics/test_units.h"

namespace twinbench::mechanics {
namespace {

TEST(LinearModel, FollowsBulletsVibrationOfADisplacedBearing) {
  StackParameters p = EccentricStack();
  p.gravity_m_s2 = 0.0;  // the linear model counts from the static deflection
  const LinearModel model(p);
  StackDynamics dynamics(p);
  Vector12 q = Vector12::Zero();
  q << 1e-7, -2e-7, 3e-7, 1e-7, 2e-7, 0.0, -1e-7, 1e-7, 2e-7, -3e-7, 1e-7, 0.0;
  q *= 0.01;  // the rotors, held by nothing, drift by the square of the vibration: 1e-5 of it at this size
  Vector12 qd = Vector12::Zero();
  LinearModel::State state;
  state << q, qd;
  for (int i = 0; i < 40; ++i) {  // 20 ms
    for (int k = 0; k < 40; ++k) dynamics.Step(Integrator::kRungeKutta4, 12.5e-6, {0.0, 0.0}, q, qd);
    state = model.Step(state, LinearModel::Input::Zero());
  }
  // Fourth-order steps of 0.067 rad of the stiffest mode err by 1e-8 each over 1600 steps: 2e-5 at most.
  const double scale = q.cwiseAbs().maxCoeff();
  EXPECT_GT(scale, 1e-10);
  EXPECT_LT((state.head<kCoordinates>() - q).cwiseAbs().maxCoeff(), 1e-4 * scale);
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

}  // namespace
}  // namespace twinbench::mechanics
