#include "mechanics/linear_model.h"

#include <cmath>
#include <limits>

#include "mechanics/linear_step.h"
#include "mechanics/matrices.h"

namespace twinbench::mechanics {
namespace {

/// Acceleration of the free stack at zero deflection while its rotors turn.
Vector12 VelocityTerm(StackDynamics& dynamics, double target_rad_s, double reference_rad_s) {
  Vector12 qd = Vector12::Zero();
  qd[SpinIndex(0)] = target_rad_s;
  qd[SpinIndex(1)] = reference_rad_s;
  return dynamics.AccelerateFreely(Vector12::Zero(), qd, Vector12::Zero());
}

/// Accelerations of the coordinates for unit inputs.
Eigen::Matrix<double, kCoordinates, LinearModel::kInputs> InputAccelerations(StackDynamics& dynamics,
                                                                             const Matrix12& inverse_mass) {
  Eigen::Matrix<double, kCoordinates, LinearModel::kInputs> inputs;
  inputs.setZero();
  const Vector12 tt = VelocityTerm(dynamics, 1.0, 0.0);
  const Vector12 rr = VelocityTerm(dynamics, 0.0, 1.0);
  inputs.col(0) = tt;
  inputs.col(1) = VelocityTerm(dynamics, 1.0, 1.0) - tt - rr;
  inputs.col(2) = rr;
  inputs.rightCols<kCoordinates>() = inverse_mass;
  return inputs;
}

}  // namespace

LinearModel::LinearModel(const StackParameters& parameters) {
  constexpr int kAll = 2 * kCoordinates + kInputs;
  const StackParameters p = InPayloadFrame(parameters);
  StackDynamics dynamics(p);
  const Matrix12 inverse_mass = dynamics.InverseMass(Vector12::Zero());
  Eigen::MatrixXd system = Eigen::MatrixXd::Zero(kAll, kAll);
  system.block<kCoordinates, kCoordinates>(0, kCoordinates).setIdentity();
  system.block<kCoordinates, kCoordinates>(kCoordinates, 0) = -inverse_mass * BearingStiffness(p).asDiagonal();
  system.block<kCoordinates, kCoordinates>(kCoordinates, kCoordinates) =
      -inverse_mass * BearingDamping(p).asDiagonal();
  accelerations_ = InputAccelerations(dynamics, inverse_mass);
  system.block<kCoordinates, kInputs>(kCoordinates, 2 * kCoordinates) = accelerations_;
  const Eigen::MatrixXd propagator = ExponentialOf(system * p.servo_period_s);
  transition_ = propagator.topLeftCorner<2 * kCoordinates, 2 * kCoordinates>();
  drive_ = propagator.topRightCorner<2 * kCoordinates, kInputs>();
}

LinearModel::State LinearModel::Step(const State& state, const Input& input) const {
  State next;
  LinearStep({transition_.data(), drive_.data(), kInputs}, state.data(), input.data(), next.data());
  return next;
}

Eigen::Matrix2d FeedForward(const StackParameters& p) {
  Eigen::Matrix2d inertia = SpinInertia(p);
  inertia(0, 1) *= p.reaction_feed_forward;
  inertia(1, 0) *= p.reaction_feed_forward;
  return inertia;
}

void PeriodCommand::Set(Eigen::Index axis, const ProfilePoint& start, const ProfilePoint& end, double period_s) {
  position_rad[axis] = start.position_rad;
  acceleration_rad_s2[axis] = start.acceleration_rad_s2;
  speed_rad_s[axis] = start.velocity_rad_s;
  gain_rad_s[axis] = end.velocity_rad_s - start.velocity_rad_s;
  lead_rad[axis] = end.position_rad - start.position_rad - start.velocity_rad_s * period_s;
}

std::array<Servo, 2> MakeServos(const StackParameters& p) {
  const Eigen::Matrix2d inertia = SpinInertia(p);
  const auto make = [&](int t) {
    const TableParameters& table = p.table[static_cast<std::size_t>(t)];
    return Servo(ServoGains::For(inertia(t, t), table.servo_Hz), p.servo_period_s, table.torque_limit_Nm);
  };
  return {make(0), make(1)};
}

std::array<LuGreFriction, 2> MakeFrictions(const StackParameters& p) {
  const Eigen::Matrix2d inertia = SpinInertia(p);
  return {LuGreFriction(p.table[0].friction, inertia(0, 0)), LuGreFriction(p.table[1].friction, inertia(1, 1))};
}

LinearStack::LinearStack(const StackParameters& parameters, const LinearModel& model)
    : model_(&model),
      feed_forward_(FeedForward(parameters)),
      servos_(MakeServos(parameters)),
      frictions_(MakeFrictions(parameters)),
      scales_{parameters.table[0].scale, parameters.table[1].scale},
      period_s_(parameters.servo_period_s) {}

/// What controllers and frictions put in for the coming period.
LinearModel::Input LinearStack::Inputs(const PeriodCommand& command) {
  const Eigen::Vector2d feed = feed_forward_ * command.acceleration_rad_s2;
  LinearModel::Input input;
  input << command.speed_products, command.load;
  for (int t = 0; t < 2; ++t) {
    const auto i = static_cast<std::size_t>(t);
    const double rate_rad_s = state_[kCoordinates + SpinIndex(t)];
    double error_rad = -state_[SpinIndex(t)];
    if (scales_[i].active())
      error_rad = command.position_rad[t] - Shown_rad(scales_[i], command.position_rad[t] - error_rad);
    torque_Nm_[t] = servos_[i].Torque(error_rad, -rate_rad_s, feed[t]);
    double& drive_Nm = input[3 + SpinIndex(t)];
    drive_Nm += torque_Nm_[t];
    if (frictions_[i].active()) drive_Nm += frictions_[i].Torque(command.speed_rad_s[t] + rate_rad_s, period_s_);
  }
  return input;
}

/// The command moves on; nothing else in the stack feels the angle between the two.
void LinearStack::Lead(const PeriodCommand& command, LinearModel::State& state) {
  for (int t = 0; t < 2; ++t) {
    state[SpinIndex(t)] -= command.lead_rad[t];
    state[kCoordinates + SpinIndex(t)] -= command.gain_rad_s[t];
  }
}

void LinearStack::Step(const PeriodCommand& command) {
  state_ = model_->Step(state_, Inputs(command));
  Lead(command, state_);
}

LinearModel::State LinearStack::Within(const PeriodCommand& command, const PeriodCommand& so_far,
                                       const StackPropagator& propagator, double since_s) const {
  const LinearModel::Input input = LinearStack(*this).Inputs(command);
  LinearModel::State state = propagator.Within(state_, model_->Accelerations(input), since_s);
  Lead(so_far, state);
  return state;
}

void LinearStack::Add(const LinearModel::State& state, const Eigen::Vector2d& integrals_rad_s) {
  state_ += state;
  for (int t = 0; t < 2; ++t) {
    Servo& servo = servos_[static_cast<std::size_t>(t)];
    servo.set_integral_rad_s(servo.integral_rad_s() + integrals_rad_s[t]);
  }
}

MoveResponse::MoveResponse(const StackParameters& parameters, const LinearModel& model, double duration_s,
                           double tail_s)
    : peak_torque_Nm_(Eigen::Matrix<double, 2, kShapes>::Zero()) {
  StackParameters linear = parameters;  // the shapes are unit moves: no limit may touch them, no friction
  for (TableParameters& table : linear.table) {
    table.torque_limit_Nm = std::numeric_limits<double>::max();
    table.friction = {};
    table.scale = {};
  }
  const double period_s = parameters.servo_period_s;
  const QuinticProfile unit(0.0, 1.0, duration_s);
  rows_.resize(static_cast<std::size_t>(std::ceil((duration_s + tail_s) / period_s)));
  for (int shape = 0; shape < kShapes; ++shape) {
    LinearStack stack(linear, model);
    for (int tick = 0; tick < size(); ++tick) {
      Record(tick, shape, stack);
      const double speed = unit.At((tick + 0.5) * period_s).velocity_rad_s;
      PeriodCommand command;
      if (shape < 2) command.Set(shape, unit.At(tick * period_s), unit.At((tick + 1) * period_s), period_s);
      if (shape >= 2) command.speed_products[shape - 2] = speed * speed;
      stack.Step(command);
    }
  }
}

void MoveResponse::Record(int tick, int shape, const LinearStack& stack) {
  auto& row = rows_[static_cast<std::size_t>(tick)];
  row.block<1, 2 * kCoordinates>(shape, 0) = stack.state().transpose();
  row.block<1, 2>(shape, 2 * kCoordinates) = stack.integrals_rad_s().transpose();
  peak_torque_Nm_.col(shape) = peak_torque_Nm_.col(shape).cwiseMax(stack.torque_Nm().cwiseAbs());
}

MoveResponse::Row MoveResponse::At(int tick, const Shapes& shapes) const {
  if (tick >= size()) return Row::Zero();
  return rows_[static_cast<std::size_t>(tick)].transpose() * shapes;
}

double MoveResponse::At(int tick, const Shapes& shapes, int coordinate) const {
  if (tick >= size()) return 0.0;
  return rows_[static_cast<std::size_t>(tick)].col(coordinate).dot(shapes);
}

Eigen::Vector2d MoveResponse::TorqueBound_Nm(const Shapes& shapes) const {
  return peak_torque_Nm_ * shapes.cwiseAbs();
}

}  // namespace twinbench::mechanics
