#include "twin/benches/hob_transmission/bench.h"

#include <algorithm>
#include <cmath>

#include "twin/benches/hob_transmission/estimators/index_errors.h"
#include "twin/benches/hob_transmission/procedure.h"
#include "twin/benches/hob_transmission/settings.h"
#include "twin/benches/hob_transmission/twin/factory.h"
#include "twin/plan/next_run.h"
#include "twin/plausible/plan.h"

namespace twinbench::benches::hob {
namespace {

int PlannedReadings(const Scenario& s) {
  return procedure::PlannedReadings(HobOf(s));
}

/// No slower than at the lowest speed. Samples that a card latched may have the time at which they were fetched, which
/// says nothing of how fast they came.
plausible::Plan PlanOf(const Scenario& s, const std::vector<Reading>&) {
  const auto& p = HobOf(s).hob_procedure;
  const double slowest_rad_s = std::ranges::min(p.hob_speeds_rad_s) / HobOf(s).transmission.HobOrder();
  return {PlannedReadings(s), p.turns * p.samples_per_turn,
          [slowest_rad_s](const Reading& before, const Reading& here) {
            const double way_rad = std::remainder(here.measured_rad - before.measured_rad, units::turn);
            return plausible::Interval{0.0, plausible::InMotion(way_rad, slowest_rad_s).usual_s};
          }};
}

}  // namespace

const Bench& Whole() {
  static const Bench bench = {
      .format = &Format(), .make_twin = MakeTwin, .follow = FollowRecord, .planned_readings = PlannedReadings,
      .plan = PlanOf, .has_controllers = true, .make_devices = MakeDevices, .drive = procedure::DriveHob,
      .evaluate = Evaluate, .score = ScoreRun, .index_errors = separate::hob::HobIndexErrors,
      .shift_design = ShiftsOf, .next_runs = NextRunsOf, .diagnose = Diagnose, .linear_run = Linear};
  return bench;
}

}  // namespace twinbench::benches::hob
