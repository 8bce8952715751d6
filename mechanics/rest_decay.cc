#include "mechanics/rest_decay.h"

#include "mechanics/linear_model.h"

namespace twinbench::mechanics {
namespace {

constexpr double kGone = 1e-18;  // m, rad, m/s, rad/s

}  // namespace

RestDecay::RestDecay(const StackParameters& p, const StackPropagator& propagator) {
  const Eigen::Matrix2d inertia = SpinInertia(p);
  Matrix period = Matrix::Zero();
  period.topLeftCorner<2 * kCoordinates, 2 * kCoordinates>() = propagator.transition();
  period.bottomRightCorner<2, 2>().setIdentity();
  for (int t = 0; t < 2; ++t) {
    const int angle = SpinIndex(t), rate = kCoordinates + SpinIndex(t), integral = 2 * kCoordinates + t;
    const double servo_Hz = p.table[static_cast<std::size_t>(t)].servo_Hz;
    const ServoGains gains = ServoGains::For(inertia(t, t), servo_Hz);
    const Eigen::Matrix<double, 2 * kCoordinates, 1> push =
        propagator.drive() * propagator.inverse_mass().col(SpinIndex(t));
    const double by_angle = gains.proportional_Nm_rad + gains.integral_Nm_rad_s * p.servo_period_s;
    period.col(angle).head<2 * kCoordinates>() -= by_angle * push;
    period.col(rate).head<2 * kCoordinates>() -= gains.derivative_Nm_s_rad * push;
    period.col(integral).head<2 * kCoordinates>() += gains.integral_Nm_rad_s * push;
    period(integral, angle) -= p.servo_period_s;
  }
  Eigen::MatrixXd power = period;
  for (int k = 0; k < kPowers; ++k, power = power * power) power_.push_back(power);
}

RestDecay::Distance RestDecay::After(const Distance& from, std::int64_t periods) const {
  if (periods >> kPowers != 0) return Distance::Zero();
  Distance distance = from;
  for (std::size_t k = 0; periods >> k != 0; ++k) {
    if (periods >> k & 1) distance = (power_[k] * distance).eval();
  }
  return distance;
}

std::int64_t RestDecay::Gone(const Distance& from) const {
  for (std::size_t k = 0; k < kPowers; ++k) {
    const Distance then = power_[k] * from;
    if (then.head<2 * kCoordinates>().cwiseAbs().maxCoeff() < kGone) return std::int64_t{1} << k;
  }
  return std::int64_t{1} << kPowers;
}

}  // namespace twinbench::mechanics
