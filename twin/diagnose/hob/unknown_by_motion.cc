#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "twin/core/units.h"
#include "twin/diagnose/hob/collector.h"

namespace twinbench::diagnose::hob {
namespace {

constexpr int kLastOrder = 24;

int LastOrder(const Collector& collect) {
  return std::min(kLastOrder, collect.common().table_orders->grid);
}

/// What dies out behind each reversal, alone and beside an offset that stays.
void AddBehindReversals(Collector& collect) {
  const SignalContext& c = collect.context();
  const Eigen::VectorXd travel_rad = TravelSinceReversal_rad(c), held = c.direction;
  const Shape decay{"decays_over",      "deg",
                    units::deg,         0.5 * units::deg,
                    720.0 * units::deg, Ratios(2.0 * units::deg, 360.0 * units::deg, 14)};
  const SeriesAt at = [=](const Eigen::VectorXd& way_rad) -> Eigen::MatrixXd {
    return held.array() * (-travel_rad.array() / way_rad[0]).exp();
  };
  const SharedBase base =
      BaseOf(collect.common().context, static_cast<int>(decay.value.size()), [at, values = decay.value](int g) {
        return at(Eigen::VectorXd::Constant(1, values[static_cast<std::size_t>(g)]));
      });
  collect.AddOver({"reversal"}, decay, base, at, [values = decay.value](int g) {
    return fmt::format("direction times a decay over {:.3g} deg behind each reversal, odd in direction",
                       values[static_cast<std::size_t>(g)] / units::deg);
  });
}

Eigen::VectorXd Acceleration(const SignalContext& c) {
  Eigen::VectorXd a = Eigen::VectorXd::Zero(c.Samples());
  for (Eigen::Index i = 1; i + 1 < a.size(); ++i) {
    const auto at = static_cast<std::size_t>(i);
    const double step_s = c.schedule.time_s[i + 1] - c.schedule.time_s[i - 1];
    const bool together = c.schedule.pass[at - 1] == c.schedule.pass[at + 1];
    if (together && step_s > 0.0) a[i] = (c.velocity_rad_s[i + 1] - c.velocity_rad_s[i - 1]) / step_s;
  }
  return a;
}

}  // namespace

void AddByDirection(Collector& collect) {
  const SignalContext& c = collect.context();
  if (c.direction.maxCoeff() == c.direction.minCoeff()) return;
  collect.Add({"direction offset", kSameShape}, c.direction, "offset locked to direction, odd in direction");
  collect.AddModulated({"direction harmonic"}, LastOrder(collect), c.direction,
                       "direction times order {} locked to table angle, odd in direction");
  AddBehindReversals(collect);
}

void AddBySpeed(Collector& collect) {
  constexpr double kDifferent = 0.05;
  const Eigen::VectorXd velocity = collect.context().velocity_rad_s, size = velocity.cwiseAbs();
  if (size.maxCoeff() - size.minCoeff() <= kDifferent * size.maxCoeff()) return;
  const Eigen::VectorXd v = Unit(velocity), speed = v.cwiseAbs();
  collect.Add({"speed", kSameShape}, v, "proportional to the velocity, odd in direction");
  collect.Add({"speed"}, speed, "proportional to the speed, even in direction");
  collect.Add({"speed"}, v.cwiseProduct(speed), "proportional to the square of the speed, odd in direction");
  const Eigen::VectorXd acceleration = Acceleration(collect.context());
  if (acceleration.cwiseAbs().maxCoeff() > 0.0)
    collect.Add({"speed"}, Unit(acceleration), "proportional to the acceleration");
  collect.AddModulated({"speed harmonic"}, LastOrder(collect), v,
                       "order {} locked to table angle, proportional to the velocity, odd in direction");
  collect.AddModulated({"speed harmonic"}, LastOrder(collect), speed,
                       "order {} locked to table angle, proportional to the speed, even in direction");
}

}  // namespace twinbench::diagnose::hob
