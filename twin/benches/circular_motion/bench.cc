#include "twin/benches/circular_motion/bench.h"

#include <algorithm>
#include <cmath>

#include "twin/benches/circular_motion/columns.h"
#include "twin/benches/circular_motion/procedure.h"
#include "twin/benches/circular_motion/twin/factory.h"
#include "twin/plan/next_run.h"
#include "twin/plausible/plan.h"

namespace twinbench::benches::circular {
namespace {

int PlannedReadings(const Scenario& s) {
  return static_cast<int>(procedure::CircleSchedule(CircularOf(s).procedure).size());
}

plausible::Plan PlanOf(const Scenario& s, const std::vector<Reading>&) {
  const auto& p = CircularOf(s).procedure;
  return {PlannedReadings(s), std::max(p.points, p.stops),
          [dwell_s = p.dwell_s](const Reading& before, const Reading& here) {
            if (!(kFeed_m_s(here) > 0.0)) return plausible::AtRest(dwell_s);
            return plausible::InMotion(std::hypot(kCommandedX_m(here) - kCommandedX_m(before),
                                                  kCommandedY_m(here) - kCommandedY_m(before)),
                                       kFeed_m_s(here));
          }};
}

}  // namespace

const Bench& Whole() {
  static const Bench bench = {
      .format = &Format(), .make_twin = MakeTwin, .follow = FollowRecord, .planned_readings = PlannedReadings,
      .plan = PlanOf, .has_controllers = true, .make_devices = MakeDevices, .drive = procedure::DriveCircles,
      .evaluate = Evaluate, .score = ScoreRun, .next_runs = NextRunsOf, .diagnose = Diagnose, .linear_run = Linear};
  return bench;
}

}  // namespace twinbench::benches::circular
