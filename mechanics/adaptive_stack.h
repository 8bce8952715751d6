#pragma once

#include <optional>
#include <vector>

#include "mechanics/drives.h"
#include "mechanics/rest_decay.h"
#include "mechanics/stack_propagator.h"

/// The whole stack by Bullet's dynamics, in as few questions to Bullet as the motion allows.
namespace twinbench::mechanics {

/// Bullet's accelerations are split into the linear part of StackPropagator, which has all that is fast and is
/// solved exactly, and a remainder (weight, centrifugal and Coriolis forces, the change of the mass matrix), which
/// changes as slowly as the tables turn. Bullet is asked for the remainder at the ends of a stride of 1 to 32 servo
/// periods; within it the remainder is a straight line, and controllers and friction act in their own rhythm:
///
///   x(t + h) = e^(A h) x(t) + h phi_1(A h) (M^-1 torque + r0 + slope (t + h/2))   exponential Adams, second order.
///
/// The slope is that of the stride before. A stride at whose end Bullet finds a remainder that was not foreseen is
/// halved until what the difference can move is below kMiss, and grows while it is well within. Reference:
/// Hochbruck and Ostermann, Acta Numerica 19 (2010) 209-286 (exponential integrators).
class AdaptiveStack {
 public:
  /// What the remainder of one stride may miss, m and rad: a fiftieth of what is asked of a reading, 1 nm, and less
  /// than a hundredth of 0.001 arcsec. What is missed decays with the bearing's vibration or by the servo.
  static constexpr double kMiss = 2e-11;
  static constexpr std::size_t kLongestStride = 32;  // servo periods

  AdaptiveStack(const StackParameters& parameters, const Vector12& coordinates);

  /// Through the servo period that begins at `time`.
  void Step(Nanoseconds time, const Commands& commands);
  /// Makes sure that Coordinates can look into the period that begins at `time`.
  void Prepare(Nanoseconds time, const Commands& commands);
  /// The commands are no longer those that were foreseen.
  void Replan() { planned_ = 0; }

  /// Bodies as they are `since_s` after the beginning of the period; rotors by their angles.
  Vector12 Coordinates(double since_s) const;
  double Spin_rad(int table) const { return ticks_[index_].state[SpinIndex(table)]; }
  /// A new period begins `since_s` after the beginning of the last one.
  void Wake(double since_s);

  /// Whether it can be left to itself at commands that rest: always if the drives are linear (no friction, no error
  /// of the scale), else once nothing moves by more than a ten thousandth of an arcsecond a second, which is then
  /// left out.
  bool CanRest() const;
  void Rest(std::int64_t periods, const std::array<double, 2>& command_rad);

  /// Takes over other bodies, at rest, with the rotors where they are.
  void Mount(const StackParameters& parameters);

 private:
  using State = StackPropagator::State;
  using Azimuths = std::array<double, 2>;
  struct Drives {
    std::array<Servo, 2> servos;
    std::array<LuGreFriction, 2> frictions;
  };
  struct Tick {  // at the beginning of a period
    State state;
    Drives drives;
    Eigen::Vector2d torque_Nm = Eigen::Vector2d::Zero();  // that led here
    Vector12 acceleration = Vector12::Zero();             // by torque and remainder, from here on
  };
  struct Standing {
    RestDecay::Distance distance = RestDecay::Distance::Zero();  // to rest, when it began
    Tick rest;
    Vector12 remainder = Vector12::Zero();
    std::int64_t passed = 0, gone = 0;  // periods
  };

  void Plan(Nanoseconds time, const Commands& commands);
  void Begin();
  void GoOn();
  void Face(const Azimuths& azimuth_rad);
  void Sweep(Nanoseconds time, const Commands& commands);
  double Foresee(const Vector12& total);
  Tick After(Tick& tick, const std::array<ProfilePoint, 2>& command, const Vector12& pushed) const;
  Eigen::Vector2d Controlled(Drives& drives, const State& state, const std::array<ProfilePoint, 2>& command) const;
  Eigen::Vector2d Rubbed(Drives& drives, const State& state, double step_s) const;
  Vector12 Pushed(const Eigen::Vector2d& torque_Nm) const;
  Vector12 Total(const Tick& tick);
  Vector12 Linear(const Tick& tick) const;
  Tick StandingTick() const;
  Tick Now(double since_s) const;
  void Stand(const std::array<double, 2>& command_rad);

  StackParameters parameters_;
  StackDynamics dynamics_;
  StackPropagator propagator_;
  std::optional<RestDecay> decay_;
  Eigen::Matrix2d feed_forward_;
  Vector12 give_s2_;  // what each coordinate gives to a lasting acceleration, on its own spring
  bool rubs_ = false, linear_drives_ = true;
  int sub_steps_ = 1;

  std::vector<Tick> ticks_;  // of the stride, in the payload's axes at its beginning
  std::size_t index_ = 0, planned_ = 0, stride_ = 1;
  Azimuths azimuth_rad_{};
  Vector12 remainder_ = Vector12::Zero(), slope_ = Vector12::Zero();  // likewise; slope a second
  std::optional<Standing> standing_;
};

}  // namespace twinbench::mechanics
