#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>

#include "twin/core/units.h"
#include "twin/diagnose/engine/candidates.h"
#include "twin/diagnose/tuning.h"
#include "twin/diagnose/unknown/collector.h"
#include "twin/model/motion.h"
#include "twin/model/signals.h"

namespace twinbench::diagnose::unknown {
namespace {

/// What dies out behind each reversal, alone and beside an offset that stays: a hysteresis of another form.
void AddBehindReversals(Collector& collect, const Eigen::VectorXd& held) {
  using units::deg;
  const Design& d = collect.design();
  if (d.travel_rad.size() == 0) return;
  // What decays over more than the way behind a reversal is a line; of places at rest, which all passes go to, over less already a
  // line and an offset, like a scale and play together.
  const bool is_at_rest = d.velocity.size() == 0 || d.velocity.isZero();
  const double longest_rad = std::min(360.0 * deg, (is_at_rest ? 0.3 : 1.0) * d.travel_rad.maxCoeff()), shortest_rad = std::min(2.0 * deg, 0.1 * longest_rad);
  if (!(longest_rad > 0.0)) return;
  const Shape decay{"decays_over", "deg", deg, 0.25 * shortest_rad, 2.0 * longest_rad, Ratios(shortest_rad, longest_rad, 14)};
  const auto left = [held, travel_rad = d.travel_rad](const Eigen::VectorXd& way_rad) -> Eigen::VectorXd {
    return held.array() * (-travel_rad.array() / way_rad[0]).exp();
  };
  const auto words = [values = decay.value](const char* what) {
    return [=](int g) { return fmt::format(fmt::runtime(what), values[static_cast<std::size_t>(g)] / deg); };
  };
  collect.AddOver(
      "reversal", decay, [left](const Eigen::VectorXd& way_rad) { return Eigen::MatrixXd(left(way_rad)); },
      words("direction times a decay over {:.3g} deg behind each reversal, odd in direction"));
  collect.AddOver(
      "transition", decay,
      [held, left](const Eigen::VectorXd& way_rad) {
        Eigen::MatrixXd columns(held.size(), 2);
        columns << held, left(way_rad);
        return columns;
      },
      words("offset, function of direction that is reached over {:.3g} deg behind each reversal, odd in direction"));
}

/// What alternates from stop to stop has exactly two of them a period: stops that are evenly spaced show one phase of
/// it and none of the other, and of their sum any size.
void AddAlternating(Collector& collect, const Angle& angle, const Eigen::VectorXd& sense, bool has_signal) {
  constexpr double kOnePhase = 1e-4;  // mean square of the sine about it
  const int order = angle.last_order + 1;
  if (angle.last_order < 1 || order > tuning::kDirectionOrders) return;
  const Eigen::ArrayXd phase_rad = order * angle.rad.array();
  const double zero_rad = 0.5 * std::arg((2.0 * std::complex<double>(0.0, 1.0) * phase_rad.cast<std::complex<double>>()).exp().sum());
  if ((phase_rad - zero_rad).sin().square().mean() > kOnePhase) return;
  const Eigen::VectorXd alternating = (phase_rad - zero_rad).cos();
  collect.Add("direction harmonic", alternating.cwiseProduct(sense).cwiseProduct(collect.design().moved),
              fmt::format("direction times order {} synchronous with {}, odd in direction", order, angle.name));
  if (!has_signal || angle.by.empty()) return;
  collect.Are([signal = Following(SignalOf("harmonic", angle.by, {{"order", order}, {"phase", -zero_rad}}), "direction")](
                  const Eigen::VectorXd&, int) { return ColumnOf(signal); });
}

}  // namespace

void AddByDirection(Collector& collect) {
  const Design& d = collect.design();
  const Eigen::VectorXd& held = d.senses.front();
  if (held.maxCoeff() == held.minCoeff()) return;
  collect.Add("direction offset", held, "offset, function of direction, odd in direction");
  collect.Are([](const Eigen::VectorXd&, int) { return ColumnOf(Following(SignalOf("constant"), "direction")); });
  for (const Angle& angle : d.angles) {
    if (!angle.is_turned_by_motion) continue;
    for (const Eigen::VectorXd& sense : d.senses) {
      const bool has_signal = &sense == &d.senses.front();
      collect.AddModulated("direction harmonic", angle, tuning::kDirectionOrders, sense,
                           "direction times order {} synchronous with " + angle.name + ", odd in direction");
      if (has_signal) collect.AreHarmonics(angle, Following({}, "direction"));
      AddAlternating(collect, angle, sense, has_signal);
    }
  }
  AddBehindReversals(collect, held);
}

void AddBySpeed(Collector& collect) {
  const Design& d = collect.design();
  if (d.velocity.size() == 0 || d.velocity.isZero()) return;
  const Eigen::VectorXd v = model::Unit(d.velocity), speed = v.cwiseAbs();
  const double per_rad_s = model::Rms(d.velocity);
  const auto is_constant = [&](const char* times) {
    collect.Are([times, per_rad_s](const Eigen::VectorXd&, int) {
      return ColumnOf(Following(SignalOf("constant"), times, 0.0, per_rad_s));
    });
  };
  collect.Add("speed", v, "proportional to the velocity, odd in direction");
  is_constant("velocity");
  if (speed.maxCoeff() - speed.minCoeff() <= tuning::kOneSpeed * speed.maxCoeff()) return;
  collect.Add("speed", speed, "proportional to the speed, even in direction");
  is_constant("speed");
  collect.Add("speed", v.cwiseProduct(speed), "proportional to the square of the speed, odd in direction");
  collect.Add("speed", model::Unit(model::SteadyCourseOf(d.course, d.velocity).rate), "proportional to the acceleration");
  if (d.angles.empty()) return;
  const Angle& angle = d.angles.front();
  if (angle.first_by_label > 1) return;  // over a part of a turn they are pieces of any function of angle and speed
  const std::string order = "order {} synchronous with " + angle.name;
  collect.AddModulated("speed harmonic", angle, tuning::kModulatedOrders, v,
                       order + ", proportional to the velocity, odd in direction");
  collect.AreHarmonics(angle, Following({}, "velocity", 0.0, per_rad_s));
  collect.AddModulated("speed harmonic", angle, tuning::kModulatedOrders, speed,
                       order + ", proportional to the speed, even in direction");
  collect.AreHarmonics(angle, Following({}, "speed", 0.0, per_rad_s));
}

}  // namespace twinbench::diagnose::unknown
