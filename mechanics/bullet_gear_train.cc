#include <BulletDynamics/Featherstone/btMultiBody.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "mechanics/gear_law.h"
#include "mechanics/position_loop.h"

static_assert(sizeof(btScalar) == 8, "link bullet-float64");

namespace twinbench::mechanics {
namespace {

/// Angles of hob motor with spindle, table motor with worm, and table.
constexpr int kHob = 0, kMotor = 1, kTable = 2, kJoints = 3;
using Vector = Eigen::Vector3d;

/// The three bodies as one multibody on a fixed base; in no world, like StackDynamics. The gears couple them
/// through joint torques. Masses do not count, as no joint moves another's axis.
class Bodies {
 public:
  explicit Bodies(const GearTrainParameters& p) : body_(kJoints, 0.0, btVector3(0, 0, 0), true, false) {
    body_.setLinearDamping(0.0);
    body_.setAngularDamping(0.0);
    body_.setMaxCoordinateVelocity(1e6);
    Add(kHob, {1, 0, 0}, p.hob.inertia_kg_m2);
    Add(kMotor, {0, 1, 0}, p.motor.inertia_kg_m2);
    Add(kTable, {0, 0, 1}, p.table_inertia_kg_m2);
    body_.finalizeMultiDof();
  }

  /// By the articulated-body algorithm with a step of zero, which leaves the state alone. A test of StackDynamics
  /// pins where Bullet leaves the accelerations, one of the gear train how fast this table swings.
  Vector Accelerate(const Vector& q, const Vector& qd, const Vector& torque_Nm) {
    for (int i = 0; i < kJoints; ++i) {
      body_.setJointPos(i, q[i]);
      body_.setJointVel(i, qd[i]);
      body_.addJointTorque(i, torque_Nm[i]);
    }
    body_.computeAccelerationsArticulatedBodyAlgorithmMultiDof(0.0, numbers_, vectors_, matrices_, false, false,
                                                               false);
    body_.clearForcesAndTorques();
    return Eigen::Map<const Vector>(&numbers_[body_.getNumDofs() + 6]);
  }

 private:
  void Add(int joint, const btVector3& axis, double inertia_kg_m2) {
    const btVector3 none(0, 0, 0);
    body_.setupRevolute(joint, 1.0, {inertia_kg_m2, inertia_kg_m2, inertia_kg_m2}, -1, {0.0, 0.0, 0.0, 1.0}, axis,
                        none, none, true);
  }

  btMultiBody body_;
  btAlignedObjectArray<btScalar> numbers_;
  btAlignedObjectArray<btVector3> vectors_;
  btAlignedObjectArray<btMatrix3x3> matrices_;
};

/// Highest frequency [rad/s]: torsion against table and motor, and the bristles of the friction.
double HighestFrequency(const GearTrainParameters& p) {
  const double at_table = p.motor.inertia_kg_m2 * p.WormRatio() * p.WormRatio();
  const double bristles_Nm_rad = p.friction.coulomb_Nm / p.friction.presliding_rad;
  return std::sqrt(p.stiffness_Nm_rad * (1.0 / p.table_inertia_kg_m2 + 1.0 / at_table) +
                   bristles_Nm_rad / p.table_inertia_kg_m2);
}

/// The leapfrog's limit is 2/omega.
int SubSteps(const GearTrainParameters& p) {
  const double longest_s = std::min(p.step_s, 1.35 / HighestFrequency(p));
  return static_cast<int>(std::ceil(p.servo_period_s / longest_s - 1e-9));
}

PositionLoop LoopOf(const DriveParameters& drive, const GearTrainParameters& p) {
  return {drive.inertia_kg_m2, drive.servo_Hz, drive.feed_forward, p.servo_period_s};
}

class BulletGearTrain : public GearTrain {
 public:
  explicit BulletGearTrain(const GearTrainParameters& p)
      : p_(p),
        law_(p),
        bodies_(p),
        hob_loop_(LoopOf(p.hob, p)),
        motor_loop_(LoopOf(p.motor, p)),
        friction_(p.friction, p.table_inertia_kg_m2),
        damping_Nm_s_(2.0 * p.damping_ratio * std::sqrt(p.stiffness_Nm_rad * p.table_inertia_kg_m2)),
        period_(ToNanoseconds(p.servo_period_s)),
        sub_steps_(SubSteps(p)) {
    q_[kMotor] = p.WormRatio() * law_.Command(0.0).value_rad;
    q_[kTable] = law_.Wheel(q_[kMotor] / p.WormRatio()).value_rad;
    before_ = after_ = Now();
  }

  void Run(double hob_speed_rad_s, double ramp_s) override { command_.Run(hob_speed_rad_s, ramp_s, now_); }

  void Advance(double dt_s) override {
    now_ += ToNanoseconds(dt_s);
    while (stepped_ < now_) Tick();
  }

  GearTrainState State() const override {
    return now_ == stepped_ ? after_ : Between(before_, after_, ToSeconds(now_));
  }

 private:
  void Tick() {
    const Eigen::Vector2d torque_Nm = DriveTorques();
    const double h = ToSeconds(period_) / sub_steps_;
    for (int i = 0; i < sub_steps_; ++i) Leap(h, torque_Nm);
    stepped_ += period_;
    before_ = after_;
    after_ = Now();
  }

  Eigen::Vector2d DriveTorques() {
    const Motion hob = command_.At(stepped_);
    const AngleSeries table = law_.Command(q_[kHob]);
    const double worm = p_.WormRatio();
    return {hob_loop_.Torque(hob.rad, hob.rad_s, q_[kHob], qd_[kHob]),
            motor_loop_.Torque(worm * table.value_rad, worm * table.slope * qd_[kHob], q_[kMotor], qd_[kMotor])};
  }

  void Leap(double h, const Eigen::Vector2d& drive_Nm) {
    q_ += 0.5 * h * qd_;
    const AngleSeries wheel = law_.Wheel(q_[kMotor] / p_.WormRatio());
    const double slope =
        wheel.slope / p_.WormRatio();  // of the wheel by the motor: also the motor's share of torque
    const double twist_Nm = Twist_Nm(wheel.value_rad - q_[kTable], slope * qd_[kMotor] - qd_[kTable]);
    const double friction_Nm = friction_.active() ? friction_.Torque(qd_[kTable], h) : 0.0;
    const Vector torque_Nm(drive_Nm[0], drive_Nm[1] - slope * twist_Nm, twist_Nm + friction_Nm);
    qd_ += h * bodies_.Accelerate(q_, qd_, torque_Nm);
    q_ += 0.5 * h * qd_;
  }

  /// Spring and damper behind the worm's play; flanks push and do not pull.
  double Twist_Nm(double twist_rad, double twist_rad_s) const {
    if (p_.backlash_rad == 0.0) return p_.stiffness_Nm_rad * twist_rad + damping_Nm_s_ * twist_rad_s;
    const double pressed_rad = std::abs(twist_rad) - 0.5 * p_.backlash_rad;
    if (pressed_rad <= 0.0) return 0.0;
    const double side = std::copysign(1.0, twist_rad);
    return side * std::max(0.0, p_.stiffness_Nm_rad * pressed_rad + side * damping_Nm_s_ * twist_rad_s);
  }

  GearTrainState Now() const {
    const AngleSeries spindle = law_.Spindle(q_[kHob]);
    const AngleSeries wheel = law_.Wheel(q_[kMotor] / p_.WormRatio());
    return {ToSeconds(stepped_),
            spindle.value_rad,
            spindle.slope * qd_[kHob],
            q_[kTable],
            qd_[kTable],
            wheel.value_rad,
            wheel.slope / p_.WormRatio() * qd_[kMotor]};
  }

  GearTrainParameters p_;
  GearLaw law_;
  Bodies bodies_;
  PositionLoop hob_loop_;
  PositionLoop motor_loop_;
  LuGreFriction friction_;
  double damping_Nm_s_;
  Nanoseconds period_;
  int sub_steps_;
  SpeedCommand command_;
  Vector q_ = Vector::Zero();
  Vector qd_ = Vector::Zero();
  Nanoseconds now_ = 0;
  Nanoseconds stepped_ = 0;  // up to when the periods are done: not before now
  GearTrainState before_;    // one period before `stepped_`
  GearTrainState after_;     // at `stepped_`
};

}  // namespace

std::unique_ptr<GearTrain> MakeBulletGearTrain(const GearTrainParameters& parameters) {
  return std::make_unique<BulletGearTrain>(parameters);
}

}  // namespace twinbench::mechanics
