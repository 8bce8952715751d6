#include <algorithm>

#include "twin/diagnose/encoder/collector.h"

namespace twinbench::diagnose::encoder {
namespace {

Eigen::VectorXd Acceleration(const SignalContext& c) {
  Eigen::VectorXd a = Eigen::VectorXd::Zero(c.Readings());
  for (Eigen::Index i = 1; i + 1 < a.size(); ++i) {
    const double step_s = c.time_s[i + 1] - c.time_s[i - 1];
    if (step_s > 0.0) a[i] = (c.velocity_rad_s[i + 1] - c.velocity_rad_s[i - 1]) / step_s;
  }
  return a;
}

}  // namespace

void AddSpeeds(Collector& collect) {
  const SignalContext& c = collect.context();
  if (!c.Moves()) return;
  const Eigen::VectorXd v = Unit(c.velocity_rad_s), speed = v.cwiseAbs();
  if (!collect.Covered("latency")) collect.Add("speed", v, "proportional to the velocity, odd in direction");
  collect.Add("speed", speed, "proportional to the speed, even in direction");
  collect.Add("speed", v.cwiseProduct(speed), "proportional to the square of the speed, odd in direction");
  collect.Add("speed", Unit(Acceleration(c)), "proportional to the acceleration");
  const int last = std::min(24, LargestOrder(c));
  AddModulated(collect, "speed harmonic", last, v,
               "order {} locked to reference angle, proportional to the velocity, odd in direction");
  AddModulated(collect, "speed harmonic", last, speed,
               "order {} locked to reference angle, proportional to the speed, even in direction");
}

}  // namespace twinbench::diagnose::encoder
