#include "twin/benches/encoder_comparison/bench.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "twin/benches/encoder_comparison/procedure.h"
#include "twin/benches/encoder_comparison/settings.h"
#include "twin/benches/encoder_comparison/twin/factory.h"
#include "twin/plan/next_run.h"
#include "twin/plausible/plan.h"

namespace twinbench::benches::encoder {
namespace {

int PlannedReadings(const Scenario& s) {
  return static_cast<int>(procedure::AngleSchedule(EncoderOf(s).encoder_procedure).size());
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

/// Of a comparison whose stops are not those of the scenario nothing but that angles take their time at their speed.
plausible::Plan PlanOf(const Scenario& s, const std::vector<Reading>& readings) {
  const EncoderProcedureSettings& p = EncoderOf(s).encoder_procedure;
  const bool are_stops = AreStopsOf(p, readings);
  plausible::Plan plan;
  plan.interval = [at_rest_s = are_stops ? p.stop_interval_s : 0.0](const Reading& before, const Reading& here) {
    const double speed_rad_s = std::min(std::abs(before.velocity_rad_s), std::abs(here.velocity_rad_s));
    if (speed_rad_s > 0.0) return plausible::InMotion(here.reference_rad - before.reference_rad, speed_rad_s);
    return at_rest_s > 0.0 ? plausible::AtRest(at_rest_s) : plausible::Interval{};
  };
  if (are_stops) {
    plan.readings = PlannedReadings(s);
    plan.positions = static_cast<int>(std::lround(p.turns * p.stops));
  }
  return plan;
}

}  // namespace

const Bench& Whole() {
  static const Bench bench = {
      .format = &Format(), .make_twin = MakeTwin, .follow = FollowRecord, .planned_readings = PlannedReadings,
      .plan = PlanOf, .has_controllers = true, .make_devices = MakeDevices, .drive = procedure::DriveComparison,
      .evaluate = Evaluate, .score = ScoreRun, .index_errors = IndexErrorsOf, .shift_design = ShiftsOf,
      .next_runs = NextRunsOf, .diagnose = Diagnose, .linear_run = Linear};
  return bench;
}

}  // namespace twinbench::benches::encoder
