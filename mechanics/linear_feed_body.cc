#include "mechanics/feed_body.h"
#include "mechanics/matrices.h"
#include "mechanics/require.h"

namespace twinbench::mechanics {
namespace {

class LinearFeedBody : public FeedBody {
 public:
  explicit LinearFeedBody(const FeedDriveParameters& p) : period_s_(p.servo_period_s) {
    Require(p.play_m == 0.0, "feed drive: the linear fidelity has no play, the bullet fidelity has");
    const double k = p.Stiffness_N_m(), d = p.Damping_N_s_m(), screw = p.ScrewMass_kg(), slide = p.mass_kg;
    Eigen::Matrix<double, 6, 6> system = Eigen::Matrix<double, 6, 6>::Zero();
    system(kNut, kNutSpeed) = system(kSlide, kSlideSpeed) = 1.0;
    system.block<1, 6>(kNutSpeed, 0) << -k / screw, -d / screw, k / screw, d / screw, 1.0 / screw, 0.0;
    system.block<1, 6>(kSlideSpeed, 0) << k / slide, d / slide, -k / slide, -(d + p.friction.viscous_N_s_m) / slide,
        0.0, 1.0 / slide;
    const Eigen::Matrix<double, 6, 6> propagator = ExponentialOf(system * period_s_);
    transition_ = propagator.topLeftCorner<4, 4>();
    drive_ = propagator.topRightCorner<4, 2>();
  }

  FeedVector Step(const FeedVector& at, double drive_N, Bristles& bristles) override {
    const double friction_N = bristles.law().coulomb > 0.0 ? -bristles.Pull(at[kSlideSpeed], period_s_) : 0.0;
    return StepPressed(at, drive_N, friction_N);
  }

  FeedVector StepPressed(const FeedVector& at, double drive_N, double friction_N) override {
    FeedVector next = at;
    next.head<4>() = transition_ * at.head<4>() + drive_ * Eigen::Vector2d(drive_N, friction_N);
    return next;
  }

 private:
  double period_s_;
  Eigen::Matrix4d transition_;
  Eigen::Matrix<double, 4, 2> drive_;
};

}  // namespace

std::unique_ptr<FeedBody> MakeLinearFeedBody(const FeedDriveParameters& parameters) {
  return std::make_unique<LinearFeedBody>(parameters);
}

}  // namespace twinbench::mechanics
