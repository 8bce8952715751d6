#include "twin/benches/plan_of.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "twin/benches/circular_motion/columns.h"
#include "twin/benches/circular_motion/settings.h"
#include "twin/benches/encoder_comparison/settings.h"
#include "twin/benches/freeform_five_axis/settings.h"
#include "twin/benches/hob_transmission/settings.h"
#include "twin/benches/names.h"
#include "twin/benches/registry.h"
#include "twin/benches/rotary_4dof/settings.h"
#include "twin/benches/turntable_autocollimator/settings.h"

namespace twinbench {
namespace {

using plausible::Interval;

constexpr double kMoveAndRead_s = 2.0;  // beside the dwell, on a real bench

Interval AtRest(double dwell_s) {
  return {dwell_s, dwell_s + kMoveAndRead_s};
}

/// Of what is driven at a speed.
Interval InMotion(double way, double speed) {
  return {std::abs(way / speed), std::abs(way / speed)};
}

/// A reading says itself how long it waited, if anything does.
Interval BesideDwell(const std::vector<double>& dwells_s, const Reading&, const Reading& here) {
  return AtRest(std::isfinite(here.dwell_s) ? here.dwell_s : std::ranges::min(dwells_s));
}

/// Whether the reference stood where the stops are planned, but for a constant of each set-up: anybody's recording
/// may be compared under a scenario that knows the device only.
bool AreStopsOf(const EncoderProcedureSettings& procedure, const std::vector<Reading>& readings) {
  constexpr double kBeside = 0.1;  // of a step
  const double step_rad = units::turn / procedure.stops;
  std::map<int, double> first;
  const auto stands = std::ranges::count_if(readings, [&](const Reading& r) {
    const double off_rad = r.reference_rad - r.position * step_rad;
    const double since_rad = off_rad - first.try_emplace(r.setup, off_rad).first->second;
    return r.direction != 0 && std::abs(std::remainder(since_rad, units::turn)) < kBeside * step_rad;
  });
  return procedure.kind == "stops" && 20 * stands > 19 * std::ssize(readings);
}

Interval BetweenAngles(double at_rest_s, const Reading& before, const Reading& here) {
  const double speed_rad_s = std::min(std::abs(before.velocity_rad_s), std::abs(here.velocity_rad_s));
  if (speed_rad_s > 0.0) return InMotion(here.reference_rad - before.reference_rad, speed_rad_s);
  return at_rest_s > 0.0 ? AtRest(at_rest_s) : Interval{};
}

/// No slower than at the lowest speed. Samples that a card latched may have the time at which they were fetched, which
/// says nothing of how fast they came.
Interval BetweenEdges(const HobSettings& s, const Reading& before, const Reading& here) {
  const double slowest = std::ranges::min(s.hob_procedure.hob_speeds_rad_s);
  const double way_rad =
      s.transmission.HobOrder() * std::remainder(here.measured_rad - before.measured_rad, units::turn);
  return {0.0, InMotion(way_rad, slowest).usual_s};
}

Interval OnCircle(const CircularSettings& s, const Reading& before, const Reading& here) {
  using namespace benches::circular;
  if (!(kFeed_m_s(here) > 0.0)) return AtRest(s.procedure.dwell_s);
  return InMotion(
      std::hypot(kCommandedX_m(here) - kCommandedX_m(before), kCommandedY_m(here) - kCommandedY_m(before)),
      kFeed_m_s(here));
}

/// A machine may well be faster than the interval that was thought of.
Interval BetweenPoses(double interval_s, const Reading&, const Reading&) {
  constexpr double kFaster = 4.0;
  return {interval_s / kFaster, interval_s + kMoveAndRead_s};
}

std::function<Interval(const Reading&, const Reading&)> IntervalOf(const Scenario& scenario, bool are_stops) {
  const auto of = [](auto interval, auto settings) {
    return [=](const Reading& before, const Reading& here) { return interval(settings, before, here); };
  };
  if (scenario.bench == kRotaryBench) return of(BesideDwell, RotaryOf(scenario).procedure.dwell_s);
  if (scenario.bench == kTurntableBench) return of(BesideDwell, TurntableOf(scenario).turntable_procedure.dwell_s);
  if (scenario.bench == kEncoderBench)
    return of(BetweenAngles, are_stops ? EncoderOf(scenario).encoder_procedure.stop_interval_s : 0.0);
  if (scenario.bench == kHobBench) return of(BetweenEdges, HobOf(scenario));
  if (scenario.bench == kCircularBench) return of(OnCircle, CircularOf(scenario));
  if (scenario.bench == kFreeformBench) return of(BetweenPoses, FreeformOf(scenario).freeform_procedure.interval_s);
  return {};
}

/// Of the longest pass; 0 of a bench whose procedure is not known here.
int PositionsOf(const Scenario& scenario) {
  if (scenario.bench == kRotaryBench) return RotaryOf(scenario).procedure.positions;
  if (scenario.bench == kTurntableBench) return TurntableOf(scenario).turntable_procedure.positions;
  if (scenario.bench == kFreeformBench) return FreeformOf(scenario).freeform_procedure.poses;
  if (scenario.bench == kCircularBench)
    return std::max(CircularOf(scenario).procedure.points, CircularOf(scenario).procedure.stops);
  if (scenario.bench == kHobBench)
    return HobOf(scenario).hob_procedure.turns * HobOf(scenario).hob_procedure.samples_per_turn;
  if (scenario.bench != kEncoderBench) return 0;
  const EncoderProcedureSettings& procedure = EncoderOf(scenario).encoder_procedure;
  return static_cast<int>(std::lround(procedure.turns * procedure.stops));
}

}  // namespace

plausible::Plan PlanOf(const Scenario& scenario, const std::vector<Reading>& readings) {
  if (scenario.title.starts_with(kImportedTitle)) return {};
  const bool are_stops =
      scenario.bench == kEncoderBench && AreStopsOf(EncoderOf(scenario).encoder_procedure, readings);
  const bool is_planned = scenario.bench != kEncoderBench || are_stops;
  if (!is_planned) return {.interval = IntervalOf(scenario, are_stops)};
  return {BenchOf(scenario).planned_readings(scenario), PositionsOf(scenario), IntervalOf(scenario, are_stops)};
}

}  // namespace twinbench
