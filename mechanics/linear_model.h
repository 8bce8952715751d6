#pragma once

#include <array>
#include <vector>

#include "mechanics/profile.h"
#include "mechanics/servo.h"
#include "mechanics/stack_propagator.h"

/// The stack reduced to small deviations from the commanded motion, solved exactly over a servo period.
namespace twinbench::mechanics {

/// Linear equations of the stack with mass matrix and velocity terms taken from Bullet.
///
/// Coordinates turn with the payload: x points from the axis towards it, in both bearings. In them the mass matrix
/// is the same for all angles of both tables, because everything else in the stack is symmetric about the axes and
/// the bearings are isotropic. So one model serves every move. Deviations are counted from the static deflection
/// (bearings) and from the commanded angle (rotors). Left out, each below 1e-4 of the response: Coriolis forces on
/// the deviations, their weight, and the reference's centring and mount tilt.
class LinearModel {
 public:
  using State = Eigen::Matrix<double, 2 * kCoordinates, 1>;  // deviations, then their rates
  static constexpr int kInputs = 3 + kCoordinates;
  /// Products of commanded speeds tt, tr, rr (centrifugal forces); forces on the twelve coordinates.
  using Input = Eigen::Matrix<double, kInputs, 1>;

  explicit LinearModel(const StackParameters& parameters);

  /// State one servo period later, for inputs that are constant meanwhile and a command that rests.
  State Step(const State& state, const Input& input) const;

  /// What the inputs accelerate the coordinates by.
  Vector12 Accelerations(const Input& input) const { return accelerations_ * input; }

 private:
  Eigen::Matrix<double, kCoordinates, kInputs> accelerations_;
  Eigen::Matrix<double, 2 * kCoordinates, 2 * kCoordinates> transition_;
  Eigen::Matrix<double, 2 * kCoordinates, kInputs> drive_;
};

/// What the two profiles do in one servo period, target first.
struct PeriodCommand {
  Eigen::Vector2d position_rad = Eigen::Vector2d::Zero();         // at its start, where the controller samples it
  Eigen::Vector2d acceleration_rad_s2 = Eigen::Vector2d::Zero();  // at its start too
  Eigen::Vector2d speed_rad_s = Eigen::Vector2d::Zero();          // at its start
  Eigen::Vector2d gain_rad_s = Eigen::Vector2d::Zero();           // of speed, over the period
  Eigen::Vector2d lead_rad = Eigen::Vector2d::Zero();             // travel beyond what the speed at its start gives
  Eigen::Vector3d speed_products = Eigen::Vector3d::Zero();       // tt, tr, rr in its middle
  Vector12 load = Vector12::Zero();                               // DriveLoads in the payload's axes

  /// Fills the entries of one axis, all but the speed products.
  void Set(Eigen::Index axis, const ProfilePoint& start, const ProfilePoint& end, double period_s);
};

/// Torques by which the controllers prepare for the commanded accelerations: own inertia, plus the share
/// `reaction_feed_forward` of what the other rotor's motion asks.
Eigen::Matrix2d FeedForward(const StackParameters& parameters);

/// The two controllers of a stack, with gains for each drive's own inertia.
std::array<Servo, 2> MakeServos(const StackParameters& parameters);
std::array<LuGreFriction, 2> MakeFrictions(const StackParameters& parameters);

/// LinearModel with its two controllers and frictions, advanced period by period.
class LinearStack {
 public:
  LinearStack(const StackParameters& parameters, const LinearModel& model);

  void Step(const PeriodCommand& command);
  /// State `since_s` after the beginning of the period of `command`. @param so_far  What the profiles do until
  /// then.
  LinearModel::State Within(const PeriodCommand& command, const PeriodCommand& so_far,
                            const StackPropagator& propagator, double since_s) const;
  /// Adds a state of the same kind; right because the equations are linear.
  void Add(const LinearModel::State& state, const Eigen::Vector2d& integrals_rad_s);

  const LinearModel::State& state() const { return state_; }
  Eigen::Vector2d integrals_rad_s() const { return {servos_[0].integral_rad_s(), servos_[1].integral_rad_s()}; }
  const Eigen::Vector2d& torque_Nm() const { return torque_Nm_; }  // of the last period, without friction

 private:
  LinearModel::Input Inputs(const PeriodCommand& command);
  static void Lead(const PeriodCommand& command, LinearModel::State& state);

  const LinearModel* model_;
  Eigen::Matrix2d feed_forward_;
  std::array<Servo, 2> servos_;
  std::array<LuGreFriction, 2> frictions_;
  std::array<ScaleParameters, 2> scales_;
  double period_s_;
  LinearModel::State state_ = LinearModel::State::Zero();
  Eigen::Vector2d torque_Nm_ = Eigen::Vector2d::Zero();
};

/// Responses of the stack from rest to a unit move of one duration: each move of that duration, of either table or
/// both together, is a sum of these five, exactly.
class MoveResponse {
 public:
  static constexpr int kShapes = 5;  // travel of target, of reference, and the products tt, tr, rr of both
  static constexpr int kRows = 2 * kCoordinates + 2;
  using Shapes = Eigen::Matrix<double, kShapes, 1>;
  using Row = Eigen::Matrix<double, kRows, 1>;  // state, then the controllers' integrals

  /// @param tail_s  How long the response is kept after the end of the profile; the slow pole of a 15 Hz servo has
  ///                fallen to 1e-9 after 0.5 s.
  MoveResponse(const StackParameters& parameters, const LinearModel& model, double duration_s, double tail_s = 0.5);

  /// Response after `tick` servo periods; zero beyond the tail.
  Row At(int tick, const Shapes& shapes) const;
  /// Deviation of one coordinate only.
  double At(int tick, const Shapes& shapes, int coordinate) const;
  int size() const { return static_cast<int>(rows_.size()); }

  /// Bound of the torque [Nm] that either drive needs for the move.
  Eigen::Vector2d TorqueBound_Nm(const Shapes& shapes) const;

 private:
  void Record(int tick, int shape, const LinearStack& stack);

  std::vector<Eigen::Matrix<double, kShapes, kRows>> rows_;  // one a tick
  Eigen::Matrix<double, 2, kShapes> peak_torque_Nm_;
};

}  // namespace twinbench::mechanics
