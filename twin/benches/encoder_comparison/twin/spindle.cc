#include "twin/benches/encoder_comparison/twin/spindle.h"

#include <algorithm>
#include <cmath>

#include "twin/core/errors.h"

namespace twinbench::sim {

CoastingSpindle::Slope CoastingSpindle::SlopeAt(double shaft_rad, double speed_rad_s) const {
  const SpindleSettings& s = spindle_;
  const double size = std::abs(speed_rad_s), sign = speed_rad_s < 0.0 ? -1.0 : 1.0;
  const double against = s.friction_rad_s2 + s.viscous_per_s * size + s.drag_per_rad * size * size +
                         s.ripple_rad_s2 * std::cos(s.ripple_order * shaft_rad);
  const double acceleration = s.torque_rad_s2 * std::cos(s.torque_order * shaft_rad) - sign * against;
  return {1.0 / speed_rad_s, acceleration / speed_rad_s};
}

void CoastingSpindle::MoveTo(double shaft_rad) {
  const double h = shaft_rad - shaft_rad_, v = speed_rad_s_, middle_rad = shaft_rad_ + 0.5 * h;
  const Slope a = SlopeAt(shaft_rad_, v);
  const Slope b = SlopeAt(middle_rad, v + 0.5 * h * a.speed_rad_s);
  const Slope c = SlopeAt(middle_rad, v + 0.5 * h * b.speed_rad_s);
  const Slope d = SlopeAt(shaft_rad, v + h * c.speed_rad_s);
  time_s_ += h / 6.0 * (a.time_s + 2.0 * b.time_s + 2.0 * c.time_s + d.time_s);
  speed_rad_s_ += h / 6.0 * (a.speed_rad_s + 2.0 * b.speed_rad_s + 2.0 * c.speed_rad_s + d.speed_rad_s);
  shaft_rad_ = shaft_rad;
  if (!(v * speed_rad_s_ > 0.0)) throw BenchError("the spindle has come to rest within a pass");
}

double CoastingSpindle::PassesAt_s(int pass, double shaft_rad, double start_rad_s) {
  if (pass != pass_) {
    time_s_ += pass_ >= 0 ? rest_s_ : 0.0;
    pass_ = pass;
    shaft_rad_ = shaft_rad;
    speed_rad_s_ = start_rad_s;
    return time_s_;
  }
  // Few steps a wave of what acts by the angle: 0.25 rad of it leave 1e-5 of its effect.
  const double waves = std::max(spindle_.torque_order, spindle_.ripple_order);
  constexpr double kStep_rad = 0.25;
  const double from_rad = shaft_rad_, way_rad = shaft_rad - shaft_rad_;
  const int steps = std::max(1, static_cast<int>(std::ceil(std::abs(way_rad) * waves / kStep_rad)));
  for (int k = 1; k <= steps; ++k) MoveTo(from_rad + way_rad * k / steps);
  return time_s_;
}

}  // namespace twinbench::sim
