#include "mechanics/drives.h"
#include "mechanics/sag.h"

namespace twinbench::mechanics {
namespace {

class BulletPlant : public DrivenPlant {
 public:
  explicit BulletPlant(const StackParameters& p)
      : DrivenPlant(p),
        dynamics_(p),
        feed_forward_(FeedForward(p)),
        servos_(MakeServos(p)),
        frictions_(MakeFrictions(p)),
        sub_steps_(SubSteps(dynamics_)),
        q_(StaticDeflection(p, 0.0, 0.0)) {}

 private:
  void Step(Nanoseconds time) override {
    const Eigen::Vector2d torque = DriveTorques(time);
    const double h = ToSeconds(period()) / sub_steps_;
    for (int i = 0; i < sub_steps_; ++i) {
      dynamics_.Step(parameters().integrator, h, torque + FrictionTorques(h), q_, qd_);
    }
    for (std::size_t i = 0; i < 2; ++i) {
      deviation_rad_[Row(i)] = q_[Spin(i)] - commands().At(i, time + period()).position_rad;
    }
  }

  Eigen::Vector2d DriveTorques(Nanoseconds time) {
    const ProfilePoint command[2] = {commands().At(0, time), commands().At(1, time)};
    const Eigen::Vector2d feed =
        feed_forward_ * Eigen::Vector2d(command[0].acceleration_rad_s2, command[1].acceleration_rad_s2);
    Eigen::Vector2d torque;
    for (std::size_t i = 0; i < 2; ++i) {
      torque[Row(i)] = servos_[i].Torque(command[i].position_rad - q_[Spin(i)],
                                         command[i].velocity_rad_s - qd_[Spin(i)], feed[Row(i)]);
    }
    return torque;
  }

  Eigen::Vector2d FrictionTorques(double step_s) {
    Eigen::Vector2d torque = Eigen::Vector2d::Zero();
    for (std::size_t i = 0; i < 2; ++i) {
      if (frictions_[i].active()) torque[Row(i)] = frictions_[i].Torque(qd_[Spin(i)], step_s);
    }
    return torque;
  }

  Eigen::Vector2d Deviation_rad() const override { return deviation_rad_; }

  std::array<BearingPose, 2> Bearings(double, double) const override {
    return {BearingOf(q_, 0), BearingOf(q_, 1)};
  }

  /// New bodies at rest, with the rotors where they were and the bearings deflected anew.
  void OnMount() override {
    dynamics_ = StackDynamics(parameters());
    q_ = StaticDeflection(parameters(), q_[SpinIndex(0)], q_[SpinIndex(1)]);
    qd_.setZero();
  }

  static Eigen::Index Row(std::size_t table) { return static_cast<Eigen::Index>(table); }
  static Eigen::Index Spin(std::size_t table) { return SpinIndex(static_cast<int>(table)); }

  StackDynamics dynamics_;
  Eigen::Matrix2d feed_forward_;
  std::array<Servo, 2> servos_;
  std::array<LuGreFriction, 2> frictions_;
  int sub_steps_;
  Vector12 q_;
  Vector12 qd_ = Vector12::Zero();
  Eigen::Vector2d deviation_rad_ = Eigen::Vector2d::Zero();
};

}  // namespace

std::unique_ptr<Plant> MakeBulletPlant(const StackParameters& parameters) {
  return std::make_unique<BulletPlant>(parameters);
}

}  // namespace twinbench::mechanics
