#include "mechanics/drives.h"
#include "mechanics/sag.h"

namespace twinbench::mechanics {
namespace {

/// Every period is integrated in equal sub-steps, and what is asked of a moment within it is integrated up to
/// there. Nothing is split off and nothing estimated, so this is what faster ways are measured by.
class FixedStepPlant : public DrivenPlant {
 public:
  explicit FixedStepPlant(const StackParameters& p)
      : DrivenPlant(p), dynamics_(p), feed_forward_(FeedForward(p)), sub_steps_(SubSteps(dynamics_)) {
    bodies_.drives = {MakeServos(p), MakeFrictions(p)};
    bodies_.q = StaticDeflection(p, 0.0, 0.0);
  }

 private:
  struct Drives {
    std::array<Servo, 2> servos;
    std::array<LuGreFriction, 2> frictions;
  };
  struct Bodies {
    Drives drives{{Servo({}, 0.0, 0.0), Servo({}, 0.0, 0.0)}, {LuGreFriction({}, 0.0), LuGreFriction({}, 0.0)}};
    Vector12 q = Vector12::Zero(), qd = Vector12::Zero();
  };

  void Step(Nanoseconds time) override {
    Integrate(time, ToSeconds(period()), bodies_);
    for (std::size_t i = 0; i < 2; ++i) {
      deviation_rad_[Row(i)] = bodies_.q[Spin(i)] - commands().At(i, time + period()).position_rad;
    }
  }

  /// From the beginning of a period on, for all of it or a part.
  void Integrate(Nanoseconds time, double for_s, Bodies& bodies) const {
    const Eigen::Vector2d torque = DriveTorques(time, bodies);
    const double h = for_s / sub_steps_;
    for (int i = 0; i < sub_steps_; ++i) {
      const Eigen::Vector2d all = torque + FrictionTorques(h, bodies);
      dynamics_.Step(h, all, bodies.q, bodies.qd);
    }
  }

  Eigen::Vector2d DriveTorques(Nanoseconds time, Bodies& bodies) const {
    const ProfilePoint command[2] = {commands().At(0, time), commands().At(1, time)};
    const Eigen::Vector2d feed =
        feed_forward_ * Eigen::Vector2d(command[0].acceleration_rad_s2, command[1].acceleration_rad_s2);
    Eigen::Vector2d torque;
    for (std::size_t i = 0; i < 2; ++i) {
      torque[Row(i)] = bodies.drives.servos[i].Torque(
          command[i].position_rad - Shown_rad(parameters().table[i].scale, bodies.q[Spin(i)]),
          command[i].velocity_rad_s - bodies.qd[Spin(i)], feed[Row(i)]);
    }
    return torque;
  }

  static Eigen::Vector2d FrictionTorques(double step_s, Bodies& bodies) {
    Eigen::Vector2d torque = Eigen::Vector2d::Zero();
    for (std::size_t i = 0; i < 2; ++i) {
      LuGreFriction& friction = bodies.drives.frictions[i];
      if (friction.active()) torque[Row(i)] = friction.Torque(bodies.qd[Spin(i)], step_s);
    }
    return torque;
  }

  Eigen::Vector2d Deviation_rad() const override { return deviation_rad_; }

  Vector12 Coordinates(Nanoseconds time, Nanoseconds since) const override {
    Bodies bodies = bodies_;
    if (since > 0) Integrate(time, ToSeconds(since), bodies);
    for (std::size_t i = 0; i < 2; ++i) bodies.q[Spin(i)] -= commands().At(i, time + since).position_rad;
    return bodies.q;
  }

  std::array<BearingPose, 2> Bearings(const Vector12& q, double, double) const override {
    return {BearingOf(q, 0), BearingOf(q, 1)};
  }

  bool CanRest() const override { return false; }
  void Rest(std::int64_t) override {}
  void OnWake(Nanoseconds) override {}  // at most a period's beginning is lost

  /// New bodies at rest, with the rotors where they were and the bearings deflected anew.
  void OnMount() override {
    dynamics_ = StackDynamics(parameters());
    bodies_.q = StaticDeflection(parameters(), bodies_.q[SpinIndex(0)], bodies_.q[SpinIndex(1)]);
    bodies_.qd.setZero();
  }

  static Eigen::Index Row(std::size_t table) { return static_cast<Eigen::Index>(table); }
  static Eigen::Index Spin(std::size_t table) { return SpinIndex(static_cast<int>(table)); }

  mutable StackDynamics dynamics_;  // its scratch memory
  Eigen::Matrix2d feed_forward_;
  int sub_steps_;
  Bodies bodies_;
  Eigen::Vector2d deviation_rad_ = Eigen::Vector2d::Zero();
};

}  // namespace

std::unique_ptr<Plant> MakeFixedStepPlant(const StackParameters& parameters) {
  return std::make_unique<FixedStepPlant>(parameters);
}

}  // namespace twinbench::mechanics
