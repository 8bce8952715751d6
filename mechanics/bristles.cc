#include "mechanics/bristles.h"

#include <cmath>

namespace twinbench::mechanics {

double BristleLaw::Slip(double speed) const {
  const double slow = speed / stribeck_speed;
  return presliding * (1.0 + (static_ratio - 1.0) * std::exp(-slow * slow));
}

double BristleLaw::SlipSlope(double speed) const {
  const double slow = speed / stribeck_speed;
  return -2.0 * slow / stribeck_speed * presliding * (static_ratio - 1.0) * std::exp(-slow * slow);
}

double Bristles::Pull(double speed, double step_s) {
  const double slip = law_.Slip(speed);
  const double end = std::copysign(slip, speed);
  const double rate_1_s = std::abs(speed) / slip;
  const double before = bend_;
  bend_ = end + (bend_ - end) * std::exp(-rate_1_s * step_s);
  const double bend_rate = (bend_ - before) / step_s;
  return law_.Stiffness() * bend_ + law_.damping * bend_rate;
}

}  // namespace twinbench::mechanics
