#include "mechanics/adaptive_stack.h"

#include <algorithm>
#include <cmath>

#include "mechanics/sag.h"

namespace twinbench::mechanics {
namespace {

constexpr double kStill = 5e-10;  // rad/s, m/s: a ten thousandth of an arcsecond a second

StackPropagator::State TurnedState(const StackPropagator::State& state, const std::array<double, 2>& azimuth_rad) {
  StackPropagator::State turned;
  turned.head<kCoordinates>() = Turned(Vector12(state.head<kCoordinates>()), azimuth_rad);
  turned.tail<kCoordinates>() = Turned(Vector12(state.tail<kCoordinates>()), azimuth_rad);
  return turned;
}

std::array<double, 2> Back(const std::array<double, 2>& azimuth_rad) {
  return {-azimuth_rad[0], -azimuth_rad[1]};
}

/// What a lasting acceleration of one moves each coordinate by, on its own spring; a rotor has none.
Vector12 Give(const StackParameters& p, const StackPropagator& propagator) {
  const Vector12 stiffness = BearingStiffness(p);
  Vector12 give_s2 = Vector12::Constant(std::numeric_limits<double>::infinity());
  for (int i = 0; i < kCoordinates; ++i) {
    if (stiffness[i] > 0.0) give_s2[i] = propagator.mass()(i, i) / stiffness[i];
  }
  return give_s2;
}

/// Parts of a period in which friction acts: a power of two, so that they are made of StackPropagator's eighths.
int FrictionSteps(const StackParameters& p) {
  int steps = 1;
  while (steps < StackPropagator::kParts && p.servo_period_s / steps > p.step_s * (1.0 + 1e-9)) steps *= 2;
  return steps;
}

}  // namespace

AdaptiveStack::AdaptiveStack(const StackParameters& p, const Vector12& coordinates)
    : parameters_(p),
      dynamics_(p),
      propagator_(p),
      feed_forward_(FeedForward(p)),
      give_s2_(Give(p, propagator_)),
      ticks_{Tick{State::Zero(), {MakeServos(p), MakeFrictions(p)}}} {
  for (const LuGreFriction& friction : ticks_[0].drives.frictions) rubs_ = rubs_ || friction.active();
  if (rubs_) sub_steps_ = FrictionSteps(p);
  linear_drives_ = !rubs_ && !p.table[0].scale.active() && !p.table[1].scale.active();
  azimuth_rad_ = PayloadAzimuths(p, coordinates[SpinIndex(0)], coordinates[SpinIndex(1)]);
  ticks_[0].state.head<kCoordinates>() = Turned(coordinates, Back(azimuth_rad_));
}

void AdaptiveStack::Step(Nanoseconds time, const Commands& commands) {
  Prepare(time, commands);
  ++index_;
}

void AdaptiveStack::Prepare(Nanoseconds time, const Commands& commands) {
  if (!standing_ && index_ >= planned_) Plan(time, commands);
}

void AdaptiveStack::Plan(Nanoseconds time, const Commands& commands) {
  ticks_ = {Tick(ticks_[index_])};
  index_ = 0;
  planned_ == 0 ? Begin() : GoOn();

  Sweep(time, commands);
  Vector12 found = Total(ticks_.back()) - Linear(ticks_.back());
  double miss = Foresee(found);
  while (miss > 1.0 && stride_ > 1) {
    stride_ /= 2;
    ticks_.resize(stride_ + 1, ticks_[0]);  // along the same line: its first half is that of the longer stride
    found = Total(ticks_.back()) - Linear(ticks_.back());
    miss = Foresee(found);
  }
  const double long_s = static_cast<double>(stride_) * propagator_.period_s();
  slope_ = (found - remainder_) / long_s;
  if (miss > 1.0) Sweep(time, commands);  // shorter it cannot be: once more along the line that was found
  remainder_ = found;
  planned_ = stride_;
  if (miss < 0.1 && stride_ < kLongestStride) stride_ *= 2;  // what is missed grows with the cube of the stride
}

/// Without a stride before: what it would have foreseen may no longer be so.
void AdaptiveStack::Begin() {
  Face(PayloadAzimuths(parameters_, Spin_rad(0), Spin_rad(1)));
  remainder_ = Total(ticks_[0]) - Linear(ticks_[0]);
  slope_.setZero();
  stride_ = 1;
}

/// From the end of a stride: the same accelerations, split anew in the payload's axes as they stand now.
void AdaptiveStack::GoOn() {
  const Vector12 total = Turned(Vector12(remainder_ + Linear(ticks_[0])), azimuth_rad_);
  const Vector12 slope = Turned(slope_, azimuth_rad_);
  Face(PayloadAzimuths(parameters_, Spin_rad(0), Spin_rad(1)));
  remainder_ = Turned(total, Back(azimuth_rad_)) - Linear(ticks_[0]);
  slope_ = Turned(slope, Back(azimuth_rad_));
}

/// Turns the state from the payload's axes as they were into those of `azimuth_rad`.
void AdaptiveStack::Face(const Azimuths& azimuth_rad) {
  if (azimuth_rad == azimuth_rad_) return;
  const Azimuths by_rad = {azimuth_rad_[0] - azimuth_rad[0], azimuth_rad_[1] - azimuth_rad[1]};
  for (Tick& tick : ticks_) tick.state = TurnedState(tick.state, by_rad);
  azimuth_rad_ = azimuth_rad;
}

/// Carries out a stride from the first tick.
void AdaptiveStack::Sweep(Nanoseconds time, const Commands& commands) {
  ticks_.resize(1, ticks_[0]);
  const double period_s = propagator_.period_s();
  const Nanoseconds period = ToNanoseconds(period_s);
  for (std::size_t k = 0; k < stride_; ++k) {
    const Nanoseconds start = time + static_cast<Nanoseconds>(k) * period;
    const double middle_s = (static_cast<double>(k) + 0.5) * period_s;
    ticks_.push_back(
        After(ticks_.back(), {commands.At(0, start), commands.At(1, start)}, remainder_ + middle_s * slope_));
  }
}

/// What the stride misses if the remainder ends at `found`, in units of kMiss: the end of a straight line that
/// begins right moves a free body by a sixth of H^2, one on a spring by no more than that gives.
double AdaptiveStack::Foresee(const Vector12& found) {
  const double long_s = static_cast<double>(stride_) * propagator_.period_s();
  const Vector12 unforeseen = found - remainder_ - long_s * slope_;
  return unforeseen.cwiseAbs().cwiseProduct(give_s2_.cwiseMin(long_s * long_s / 6.0)).maxCoeff() / kMiss;
}

AdaptiveStack::Tick AdaptiveStack::After(Tick& tick, const std::array<ProfilePoint, 2>& command,
                                         const Vector12& pushed) const {
  Tick next{tick.state, tick.drives};
  const Eigen::Vector2d controlled_Nm = Controlled(next.drives, tick.state, command);
  for (int i = 0; i < sub_steps_; ++i) {
    next.torque_Nm = controlled_Nm;
    if (rubs_) next.torque_Nm += Rubbed(next.drives, next.state, propagator_.period_s() / sub_steps_);
    const Vector12 acceleration = pushed + Pushed(next.torque_Nm);
    if (i == 0) tick.acceleration = acceleration;
    next.state = propagator_.Step(next.state, acceleration, StackPropagator::kParts / sub_steps_);
  }
  return next;
}

Eigen::Vector2d AdaptiveStack::Controlled(Drives& drives, const State& state,
                                          const std::array<ProfilePoint, 2>& command) const {
  const Eigen::Vector2d feed =
      feed_forward_ * Eigen::Vector2d(command[0].acceleration_rad_s2, command[1].acceleration_rad_s2);
  Eigen::Vector2d torque_Nm;
  for (int t = 0; t < 2; ++t) {
    const auto i = static_cast<std::size_t>(t);
    torque_Nm[t] = drives.servos[i].Torque(
        command[i].position_rad - Shown_rad(parameters_.table[i].scale, state[SpinIndex(t)]),
        command[i].velocity_rad_s - state[kCoordinates + SpinIndex(t)], feed[t]);
  }
  return torque_Nm;
}

Eigen::Vector2d AdaptiveStack::Rubbed(Drives& drives, const State& state, double step_s) const {
  Eigen::Vector2d torque_Nm = Eigen::Vector2d::Zero();
  for (int t = 0; t < 2; ++t) {
    LuGreFriction& friction = drives.frictions[static_cast<std::size_t>(t)];
    if (friction.active()) torque_Nm[t] = friction.Torque(state[kCoordinates + SpinIndex(t)], step_s);
  }
  return torque_Nm;
}

/// Accelerations by the drives.
Vector12 AdaptiveStack::Pushed(const Eigen::Vector2d& torque_Nm) const {
  return propagator_.inverse_mass().col(SpinIndex(0)) * torque_Nm[0] +
         propagator_.inverse_mass().col(SpinIndex(1)) * torque_Nm[1];
}

/// Accelerations as Bullet has them.
Vector12 AdaptiveStack::Total(const Tick& tick) {
  const State state = TurnedState(tick.state, azimuth_rad_);
  const Vector12 total =
      dynamics_.Accelerate(state.head<kCoordinates>(), state.tail<kCoordinates>(), tick.torque_Nm);
  return Turned(total, Back(azimuth_rad_));
}

/// The share of it that is not the remainder.
Vector12 AdaptiveStack::Linear(const Tick& tick) const {
  return propagator_.Acceleration(tick.state) + Pushed(tick.torque_Nm);
}

Vector12 AdaptiveStack::Coordinates(double since_s) const {
  return Turned(Vector12(Now(since_s).state.head<kCoordinates>()), azimuth_rad_);
}

AdaptiveStack::Tick AdaptiveStack::Now(double since_s) const {
  if (standing_ && standing_->passed >= standing_->gone) return standing_->rest;
  Tick now = standing_ ? StandingTick() : ticks_[index_];
  if (since_s > 0.0) now.state = propagator_.Within(now.state, now.acceleration, since_s);
  return now;
}

void AdaptiveStack::Wake(double since_s) {
  ticks_ = {Now(since_s)};
  index_ = planned_ = 0;
  standing_.reset();
}

bool AdaptiveStack::CanRest() const {
  return linear_drives_ || ticks_[index_].state.tail<kCoordinates>().cwiseAbs().maxCoeff() < kStill;
}

void AdaptiveStack::Rest(std::int64_t periods, const std::array<double, 2>& command_rad) {
  if (!standing_) Stand(command_rad);
  standing_->passed += periods;
}

/// Where springs, weight and controllers hold each other, and how far from there it is.
void AdaptiveStack::Stand(const std::array<double, 2>& command_rad) {
  Tick here = ticks_[index_];
  standing_.emplace(Standing{.rest = here});
  standing_->rest.state.tail<kCoordinates>().setZero();
  standing_->rest.acceleration.setZero();
  if (!linear_drives_) return;
  standing_->remainder = Total(here) - Linear(here);
  const Vector12 load = propagator_.mass() * standing_->remainder;
  const Vector12 stiffness = BearingStiffness(parameters_);
  Tick& rest = standing_->rest;
  for (int i = 0; i < kCoordinates; ++i) {
    if (stiffness[i] > 0.0) rest.state[i] = load[i] / stiffness[i];
  }
  const Eigen::Matrix2d inertia = SpinInertia(parameters_);
  for (int t = 0; t < 2; ++t) {
    const auto i = static_cast<std::size_t>(t);
    const ServoGains gains = ServoGains::For(inertia(t, t), parameters_.table[i].servo_Hz);
    rest.state[SpinIndex(t)] = command_rad[i];
    rest.torque_Nm[t] = -load[SpinIndex(t)];
    rest.drives.servos[i].set_integral_rad_s(rest.torque_Nm[t] / gains.integral_Nm_rad_s);
  }
  standing_->distance << here.state - rest.state,
      here.drives.servos[0].integral_rad_s() - rest.drives.servos[0].integral_rad_s(),
      here.drives.servos[1].integral_rad_s() - rest.drives.servos[1].integral_rad_s();
  if (!decay_) decay_.emplace(parameters_, propagator_);
  standing_->gone = decay_->Gone(standing_->distance);
}

AdaptiveStack::Tick AdaptiveStack::StandingTick() const {
  const RestDecay::Distance distance = decay_->After(standing_->distance, standing_->passed);
  Tick tick = standing_->rest;
  tick.state += distance.head<2 * kCoordinates>();
  std::array<ProfilePoint, 2> command;
  for (int t = 0; t < 2; ++t) {
    const auto i = static_cast<std::size_t>(t);
    Servo& servo = tick.drives.servos[i];
    servo.set_integral_rad_s(servo.integral_rad_s() + distance[2 * kCoordinates + t]);
    command[i].position_rad = standing_->rest.state[SpinIndex(t)];
  }
  After(tick, command, standing_->remainder);  // for the acceleration from here on
  return tick;
}

void AdaptiveStack::Mount(const StackParameters& p) {
  const double target_rad = Coordinates(0.0)[SpinIndex(0)], reference_rad = Coordinates(0.0)[SpinIndex(1)];
  Wake(0.0);
  parameters_ = p;
  dynamics_ = StackDynamics(p);
  azimuth_rad_ = PayloadAzimuths(p, target_rad, reference_rad);
  ticks_[0].state.setZero();
  ticks_[0].state.head<kCoordinates>() = Turned(StaticDeflection(p, target_rad, reference_rad), Back(azimuth_rad_));
}

}  // namespace twinbench::mechanics
