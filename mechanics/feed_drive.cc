#include "mechanics/feed_drive.h"

#include <cmath>
#include <stdexcept>

#include "mechanics/require.h"

namespace twinbench::mechanics {
namespace {

std::unique_ptr<FeedBody> MakeBody(Fidelity fidelity, const FeedDriveParameters& p) {
  Check(p);
  if (fidelity == Fidelity::kLinear) return MakeLinearFeedBody(p);
  if (fidelity == Fidelity::kBullet) return MakeBulletFeedBody(p);
  throw std::invalid_argument("feed drive: there is a linear and a bullet fidelity, a kinematic one needs no body");
}

}  // namespace

FeedDrive::FeedDrive(Fidelity fidelity, const FeedDriveParameters& parameters, CircleAxis axis)
    : p_(parameters),
      axis_(axis),
      motion_(1.0, 0.0, 0.0, 0.0),
      body_(MakeBody(fidelity, parameters)),
      loop_(parameters.Loop()),
      bristles_(parameters.Law()),
      calm_(parameters, *body_),
      at_(FeedVector::Zero()) {}

FeedDrive::~FeedDrive() = default;
FeedDrive::FeedDrive(FeedDrive&&) noexcept = default;
FeedDrive& FeedDrive::operator=(FeedDrive&&) noexcept = default;

void FeedDrive::Begin(const CircleMotion& motion) {
  Require(motion.IsSteady() && motion.rate_rad_s() != 0.0, "feed drive: begins at a constant rate");
  tick_ = 0;
  Command(motion);
  at_ = calm_.Steady(Phasor_m(0));
  bristles_.set_bend(calm_.SteadyBend_m(Phasor_m(0)));
  loop_.set_left_rad(at_[kIntegral]);
}

void FeedDrive::Command(const CircleMotion& motion) {
  motion_ = motion;
  if (motion.IsSteady() && motion.rate_rad_s() != 0.0) calm_.SetRate(motion.rate_rad_s());
}

void FeedDrive::Step(double until_s) {
  if (!leaps_ || !Leap(until_s)) Tick();
}

void FeedDrive::Tick() {
  const CircleMotion::Point command = motion_.At(axis_, time_s());
  const double r_m = p_.Transmission_m();
  const double encoder_m = p_.encoder == FeedEncoder::kMotor ? at_[kNut] : at_[kSlide];
  const double torque_Nm = loop_.Torque(command.m / r_m, command.m_s / r_m, encoder_m / r_m, at_[kNutSpeed] / r_m);
  at_ = body_->Step(at_, torque_Nm / r_m, bristles_);
  at_[kIntegral] = loop_.left_rad();
  ++tick_;
}

std::complex<double> FeedDrive::Phasor_m(std::int64_t tick) const {
  return std::polar(motion_.radius_m(), motion_.Phase_rad(axis_, static_cast<double>(tick) * p_.servo_period_s));
}

bool FeedDrive::Leap(double until_s) {
  if (!motion_.IsSteady()) return false;
  const int most = static_cast<int>(std::min(1e6, (until_s - time_s()) / p_.servo_period_s));
  if (motion_.rate_rad_s() == 0.0) return Rest(most);
  const std::complex<double> here_m = Phasor_m(tick_);
  const int periods = calm_.Periods(at_, bristles_.bend(), here_m, most);
  if (periods < 2) return false;
  const std::complex<double> there_m = Phasor_m(tick_ + periods);
  at_ = calm_.Leap(at_, here_m, there_m, periods);
  bristles_.set_bend(calm_.SteadyBend_m(there_m));
  loop_.set_left_rad(at_[kIntegral]);
  tick_ += periods;
  return true;
}

bool FeedDrive::Rest(int most) {
  if (most < 2) return false;
  const auto rested = calm_.Rest(at_, bristles_.bend(), motion_.At(axis_, time_s()).m, most);
  if (!rested) return false;
  at_ = rested->at;
  bristles_.set_bend(rested->bend_m);
  loop_.set_left_rad(at_[kIntegral]);
  tick_ += rested->periods;
  return true;
}

double FeedDrive::time_s() const {
  return static_cast<double>(tick_) * p_.servo_period_s;
}

FeedState FeedDrive::State() const {
  return {time_s(), at_[kSlide], at_[kSlideSpeed], at_[kNut], at_[kNutSpeed]};
}

}  // namespace twinbench::mechanics
