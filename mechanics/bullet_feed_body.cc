#include <BulletDynamics/Featherstone/btMultiBody.h>

#include <algorithm>
#include <cmath>

#include "mechanics/feed_body.h"

static_assert(sizeof(btScalar) == 8, "link bullet-float64");

namespace twinbench::mechanics {
namespace {

constexpr int kScrewJoint = 0, kSlideJoint = 1;

/// Highest frequency [rad/s]: screw against slide, and the bristles of the guideway.
double HighestFrequency(const FeedDriveParameters& p) {
  const double bristles_N_m = p.friction.coulomb_N / p.friction.presliding_m;
  return std::sqrt(p.Stiffness_N_m() * (1.0 / p.mass_kg + 1.0 / p.ScrewMass_kg()) + bristles_N_m / p.mass_kg);
}

/// The leapfrog's limit is 2/omega.
int SubSteps(const FeedDriveParameters& p) {
  const double longest_s = std::min(p.step_s, 1.35 / HighestFrequency(p));
  return static_cast<int>(std::ceil(p.servo_period_s / longest_s - 1e-9));
}

/// The two bodies as one multibody on a fixed base, in no world, like StackDynamics. The nut couples them through
/// joint forces, for it has play.
class BulletFeedBody : public FeedBody {
 public:
  explicit BulletFeedBody(const FeedDriveParameters& p)
      : stiffness_N_m_(p.Stiffness_N_m()),
        damping_N_s_m_(p.Damping_N_s_m()),
        viscous_N_s_m_(p.friction.viscous_N_s_m),
        half_play_m_(0.5 * p.play_m),
        transmission_m_(p.Transmission_m()),
        steps_(SubSteps(p)),
        step_s_(p.servo_period_s / steps_),
        body_(2, 0.0, btVector3(0, 0, 0), true, false) {
    body_.setLinearDamping(0.0);
    body_.setAngularDamping(0.0);
    body_.setMaxCoordinateVelocity(1e9);
    const btVector3 none(0, 0, 0), along(1, 0, 0);
    const btQuaternion straight(0.0, 0.0, 0.0, 1.0);
    const double j = p.screw_inertia_kg_m2;
    body_.setupRevolute(kScrewJoint, 1.0, {j, j, j}, -1, straight, along, none, none, true);
    body_.setupPrismatic(kSlideJoint, p.mass_kg, {1.0, 1.0, 1.0}, -1, straight, along, none, none, true);
    body_.finalizeMultiDof();
  }

  FeedVector Step(const FeedVector& at, double drive_N, Bristles& bristles) override {
    const bool rubs = bristles.law().coulomb > 0.0;
    return Run(
        at, drive_N, [this](double u_m, double u_m_s) { return Press_N(u_m, u_m_s); },
        [&](double speed_m_s) { return rubs ? -bristles.Pull(speed_m_s, step_s_) : 0.0; });
  }

  FeedVector StepPressed(const FeedVector& at, double drive_N, double friction_N) override {
    return Run(
        at, drive_N, [this](double u_m, double u_m_s) { return stiffness_N_m_ * u_m + damping_N_s_m_ * u_m_s; },
        [friction_N](double) { return friction_N; });
  }

 private:
  /// Leapfrog. Joints: angle of the screw, place of the slide.
  template <class Press, class Rub>
  FeedVector Run(const FeedVector& at, double drive_N, Press press, Rub rub) {
    Eigen::Vector2d q(at[kNut] / transmission_m_, at[kSlide]);
    Eigen::Vector2d qd(at[kNutSpeed] / transmission_m_, at[kSlideSpeed]);
    for (int i = 0; i < steps_; ++i) {
      q += 0.5 * step_s_ * qd;
      const double press_N = press(transmission_m_ * q[0] - q[1], transmission_m_ * qd[0] - qd[1]);
      const double slide_N = press_N + rub(qd[1]) - viscous_N_s_m_ * qd[1];
      qd += step_s_ * Accelerate(q, qd, {transmission_m_ * (drive_N - press_N), slide_N});
      q += 0.5 * step_s_ * qd;
    }
    FeedVector next = at;
    next.head<4>() << transmission_m_ * q[0], transmission_m_ * qd[0], q[1], qd[1];
    return next;
  }

  /// Spring and damper behind the play; flanks push and do not pull.
  double Press_N(double u_m, double u_m_s) const {
    if (half_play_m_ == 0.0) return stiffness_N_m_ * u_m + damping_N_s_m_ * u_m_s;
    const double pressed_m = std::abs(u_m) - half_play_m_;
    if (pressed_m <= 0.0) return 0.0;
    const double side = std::copysign(1.0, u_m);
    return side * std::max(0.0, stiffness_N_m_ * pressed_m + side * damping_N_s_m_ * u_m_s);
  }

  /// By the articulated-body algorithm with a step of zero, which leaves the state alone. A test of StackDynamics
  /// pins where Bullet leaves the accelerations, one of the feed drive how fast this screw swings.
  Eigen::Vector2d Accelerate(const Eigen::Vector2d& q, const Eigen::Vector2d& qd, const Eigen::Vector2d& force) {
    for (int i = 0; i < 2; ++i) {
      body_.setJointPos(i, q[i]);
      body_.setJointVel(i, qd[i]);
      body_.addJointTorque(i, force[i]);
    }
    body_.computeAccelerationsArticulatedBodyAlgorithmMultiDof(0.0, numbers_, vectors_, matrices_, false, false,
                                                               false);
    body_.clearForcesAndTorques();
    return Eigen::Map<const Eigen::Vector2d>(&numbers_[body_.getNumDofs() + 6]);
  }

  double stiffness_N_m_, damping_N_s_m_, viscous_N_s_m_, half_play_m_, transmission_m_;
  int steps_;
  double step_s_;
  btMultiBody body_;
  btAlignedObjectArray<btScalar> numbers_;
  btAlignedObjectArray<btVector3> vectors_;
  btAlignedObjectArray<btMatrix3x3> matrices_;
};

}  // namespace

std::unique_ptr<FeedBody> MakeBulletFeedBody(const FeedDriveParameters& parameters) {
  return std::make_unique<BulletFeedBody>(parameters);
}

}  // namespace twinbench::mechanics
