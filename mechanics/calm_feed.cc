#include "mechanics/calm_feed.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "mechanics/require.h"

namespace twinbench::mechanics {
namespace {

using Complex = std::complex<double>;

constexpr double kLongest_rad =
    0.5 * std::numbers::pi / 180.0;  // of a leap: cubics between its ends are then good to 0.01 nm
constexpr double kNearer = 0.25;     // share of the way to the reversal that a leap may go
constexpr double kSlipped = 20.0;    // presliding lengths from a reversal: e^-20 of the bend is left, 2e-9
constexpr double kSameBend = 1e-5, kSameSpeed = 1e-3;  // of presliding length and speed
constexpr double kLate = 1e-4;  // of the bend, by which it comes late; its square is neglected
constexpr int kPowers = 24, kForEver = 50;  // of two, in periods
constexpr double kNearRest_m = 10e-9, kAtRest_m = 0.1e-9;
constexpr int kPeriodsToRest = 40;

}  // namespace

CalmFeed::CalmFeed(const FeedDriveParameters& parameters, FeedBody& body) : p_(parameters), law_(parameters.Law()) {
  Matrix map;
  for (int i = 0; i < 5; ++i) map.col(i) = Period(body, FeedVector::Unit(i), 0.0, 0.0, 0.0);
  powers_ = {map};
  for (int k = 1; k < kPowers; ++k) powers_.push_back(powers_.back() * powers_.back());
  Matrix late = powers_.back();
  for (int k = kPowers; k < kForEver; ++k) late = late * late;
  Require(
      late.norm() < 1.0,  // what an eigenvalue of 1 or more keeps has not faded
      "feed drive: the servo is not stable; gains are too high for the screw or the servo period, or the integral "
      "time is too short");
  by_command_ = Period(body, FeedVector::Zero(), 1.0, 0.0, 0.0);
  by_command_rate_ = Period(body, FeedVector::Zero(), 0.0, 1.0, 0.0);
  by_friction_ = Period(body, FeedVector::Zero(), 0.0, 0.0, 1.0);
  const Eigen::FullPivLU<Matrix> rest(Matrix::Identity() - map);
  constant_ = rest.solve(by_friction_);
  growing_ = -rest.solve(constant_);
  response_.setZero();
}

FeedVector CalmFeed::Period(FeedBody& body, const FeedVector& at, double command_m, double command_m_s,
                            double friction_N) const {
  const double r_m = p_.Transmission_m();
  const double encoder_m = p_.encoder == FeedEncoder::kMotor ? at[kNut] : at[kSlide];
  PositionLoop loop = p_.Loop();
  loop.set_left_rad(at[kIntegral]);
  const double torque_Nm = loop.Torque(command_m / r_m, command_m_s / r_m, encoder_m / r_m, at[kNutSpeed] / r_m);
  FeedVector next = body.StepPressed(at, torque_Nm / r_m, friction_N);
  next[kIntegral] = loop.left_rad();
  return next;
}

void CalmFeed::SetRate(double rate_rad_s) {
  rate_rad_s_ = rate_rad_s;
  const Complex turn = std::polar(1.0, rate_rad_s * p_.servo_period_s), rate(0.0, rate_rad_s);
  const Eigen::Matrix<Complex, 5, 5> left = turn * Matrix::Identity() - powers_.front();
  // Nearly all of it is the command itself; what differs is solved for, so that nothing cancels.
  Eigen::Matrix<Complex, 5, 1> exact;
  exact << 1.0, rate, 1.0, rate, 0.0;
  response_ = exact + left.fullPivLu().solve(by_command_ + rate * by_command_rate_ - left * exact);
}

CalmFeed::Slip CalmFeed::SlipOf(Complex command_m) const {
  const Complex speed_m_s = response_[kSlideSpeed] * command_m;
  return {speed_m_s.real(), (Complex(0.0, rate_rad_s_) * speed_m_s).real()};
}

/// The bend at which the bristles slip follows the speed, and they follow it late.
double CalmFeed::Bend_m(const Slip& slip) const {
  const double speed_m_s = std::abs(slip.speed_m_s), slip_m = law_.Slip(speed_m_s);
  const double gain_m_s2 = slip.speed_m_s > 0.0 ? slip.acceleration_m_s2 : -slip.acceleration_m_s2;
  const double rate_m_s = law_.SlipSlope(speed_m_s) * gain_m_s2;
  return std::copysign(slip_m * (1.0 - rate_m_s / speed_m_s), slip.speed_m_s);
}

double CalmFeed::Friction_N(const Slip& slip) const {
  if (law_.coulomb == 0.0) return 0.0;
  const double rate_m_s = law_.SlipSlope(std::abs(slip.speed_m_s)) * slip.acceleration_m_s2;
  return -(law_.Stiffness() * Bend_m(slip) + law_.damping * rate_m_s);
}

bool CalmFeed::BendsLate(const Slip& slip) const {
  return std::abs(law_.SlipSlope(slip.speed_m_s) * slip.acceleration_m_s2 / slip.speed_m_s) > kLate;
}

bool CalmFeed::Pressed(const Slip& slip) const {
  const double press_N =
      p_.mass_kg * slip.acceleration_m_s2 + p_.friction.viscous_N_s_m * slip.speed_m_s - Friction_N(slip);
  return p_.play_m == 0.0 || press_N * slip.speed_m_s > 0.0;
}

FeedVector CalmFeed::Play(double sense) const {
  const double half_m = std::copysign(0.5 * p_.play_m, sense);
  FeedVector play = FeedVector::Zero();
  if (p_.encoder == FeedEncoder::kMotor) play[kSlide] = -half_m;
  if (p_.encoder == FeedEncoder::kSlide) play[kNut] = half_m;
  return play;
}

FeedVector CalmFeed::Steady(Complex command_m) const {
  const Slip slip = SlipOf(command_m);
  return Circle(command_m) + Friction_N(slip) * constant_ + Play(slip.speed_m_s);
}

double CalmFeed::SteadyBend_m(Complex command_m) const {
  return law_.coulomb > 0.0 ? Bend_m(SlipOf(command_m)) : 0.0;
}

int CalmFeed::Periods(const FeedVector& at, double bend_m, Complex command_m, int most) const {
  const double step_rad = std::abs(rate_rad_s_) * p_.servo_period_s;
  if (law_.coulomb == 0.0) return std::min(most, static_cast<int>(kLongest_rad / step_rad));
  const Complex phasor_m_s = response_[kSlideSpeed] * command_m;
  const double phase_rad = std::copysign(1.0, rate_rad_s_) * std::arg(phasor_m_s);               // 0: fastest
  const double left_rad = 0.5 * std::numbers::pi - std::remainder(phase_rad, std::numbers::pi);  // to the reversal
  const double leap_rad = std::min(kLongest_rad, kNearer * left_rad);
  const int periods = std::min(most, static_cast<int>(leap_rad / step_rad));
  const double travel_m = std::abs(phasor_m_s / rate_rad_s_) * (1.0 - std::cos(left_rad - leap_rad));
  if (periods == 0 || travel_m < kSlipped * law_.static_ratio * law_.presliding) return 0;
  const Slip here = SlipOf(command_m),
             there = SlipOf(command_m * std::polar(1.0, rate_rad_s_ * periods * p_.servo_period_s));
  const double off_m_s = at[kSlideSpeed] - here.speed_m_s;
  const bool steady = std::abs(off_m_s) <= kSameSpeed * std::abs(here.speed_m_s);
  if (!steady || BendsLate(here) || BendsLate(there) || !Pressed(here) || !Pressed(there)) return 0;
  if (std::abs(bend_m - Bend_m({at[kSlideSpeed], here.acceleration_m_s2})) > kSameBend * law_.presliding) return 0;
  const double pushed_m = std::copysign(1.0, here.speed_m_s) * (at[kNut] - at[kSlide]);
  return p_.play_m > 0.0 && pushed_m <= 0.5 * p_.play_m ? 0 : periods;
}

FeedVector CalmFeed::Leap(const FeedVector& at, Complex from_m, Complex to_m, int periods) const {
  const Slip here = SlipOf(from_m), there = SlipOf(to_m);
  const double from_N = Friction_N(here), to_N = Friction_N(there);
  const FeedVector grows = (to_N - from_N) / periods * growing_;
  FeedVector off = at - Play(here.speed_m_s) - Circle(from_m) - from_N * constant_ - grows;
  for (std::size_t k = 0; periods >> k; ++k) {
    if (periods >> k & 1) off = powers_[k] * off;
  }
  return off + Play(there.speed_m_s) + Circle(to_m) + to_N * constant_ + grows;
}

CalmFeed::Spring CalmFeed::SpringOf(double bend_m, double speed_m_s) const {
  if (law_.coulomb == 0.0) return {0.0, 0.0};
  const double gives = 1.0 - std::copysign(1.0, speed_m_s) * bend_m / law_.Slip(0.0);
  return {gives, law_.Stiffness() * bend_m};
}

CalmFeed::Matrix CalmFeed::MapOnSpring(double gives) const {
  Matrix map = powers_.front();
  if (gives == 0.0) return map;
  map.col(kSlide) -= gives * law_.Stiffness() * by_friction_;
  map.col(kSlideSpeed) -= gives * law_.damping * by_friction_;
  return map;
}

/// Both outside the play and on the same side.
bool CalmFeed::StaysPressed(const FeedVector& from, const FeedVector& to) const {
  const double sense = std::copysign(1.0, from[kNut] - from[kSlide]);
  const double least_m = std::min(sense * (from[kNut] - from[kSlide]), sense * (to[kNut] - to[kSlide]));
  return p_.play_m == 0.0 || least_m > 0.5 * p_.play_m;
}

std::optional<CalmFeed::Rested> CalmFeed::Rest(const FeedVector& at, double bend_m, double command_m,
                                               int most) const {
  if (std::abs(at[kSlideSpeed]) > kNearRest_m * p_.position_gain_1_s) return std::nullopt;
  const Spring spring = SpringOf(bend_m, at[kSlideSpeed]);
  Matrix map = MapOnSpring(spring.gives);
  const FeedVector play = Play(at[kNut] - at[kSlide]), from = at - play;
  const FeedVector held =
      by_command_ * command_m - spring.bent_N * by_friction_ + (powers_.front() - map).col(kSlide) * from[kSlide];
  const FeedVector ends = (Matrix::Identity() - map).fullPivLu().solve(held), off = from - ends;
  const double left_m = std::max(std::abs(off[kSlide]), std::abs(off[kNut]));
  if (left_m > kNearRest_m || !StaysPressed(at, ends + play)) return std::nullopt;
  const int periods = left_m > kAtRest_m ? std::min(most, kPeriodsToRest) : most;
  FeedVector then = off;
  for (int left = periods; left > 0; left >>= 1) {
    if (left & 1) then = map * then;
    map = map * map;
  }
  if (!(std::abs(then[kSlide]) <= left_m)) return std::nullopt;  // it swings still
  then += ends + play;
  return Rested{then, bend_m + spring.gives * (then[kSlide] - at[kSlide]), periods};
}

}  // namespace twinbench::mechanics
