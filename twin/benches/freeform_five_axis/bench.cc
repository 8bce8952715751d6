#include "twin/benches/freeform_five_axis/bench.h"

#include "twin/benches/freeform_five_axis/procedure/drive.h"
#include "twin/benches/freeform_five_axis/settings.h"
#include "twin/benches/freeform_five_axis/twin/factory.h"
#include "twin/plan/next_run.h"

namespace twinbench::benches::freeform {
namespace {

int PlannedReadings(const Scenario& scenario) {
  const FreeformProcedureSettings& p = FreeformOf(scenario).freeform_procedure;
  return 2 * p.poses * static_cast<int>(p.mounts.size());
}

}  // namespace

const Bench& Whole() {
  static const Bench bench = [] {
    Bench b;
    b.format = &Format();
    b.make_twin = MakeTwin;
    b.has_controllers = true;
    b.make_devices = MakeDevices;
    b.drive = procedure::DriveFreeform;
    b.follow = FollowRecord;
    b.planned_readings = PlannedReadings;
    b.evaluate = Evaluate;
    b.score = ScoreRun;
    b.next_runs = NextRunsOf;
    b.diagnose = Diagnose;
    b.linear_run = Linear;
    return b;
  }();
  return bench;
}

}  // namespace twinbench::benches::freeform
