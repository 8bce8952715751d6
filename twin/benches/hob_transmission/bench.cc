#include "twin/benches/hob_transmission/bench.h"

#include "twin/benches/hob_transmission/estimators/index_errors.h"
#include "twin/benches/hob_transmission/procedure.h"
#include "twin/benches/hob_transmission/procedure/drive.h"
#include "twin/benches/hob_transmission/settings.h"
#include "twin/benches/hob_transmission/twin/factory.h"
#include "twin/plan/next_run.h"

namespace twinbench::benches::hob {
namespace {

int PlannedReadings(const Scenario& s) {
  return procedure::PlannedReadings(HobOf(s));
}

}  // namespace

const Bench& Whole() {
  static const Bench bench = [] {
    Bench b;
    b.format = &Format();
    b.make_twin = MakeTwin;
    b.has_controllers = true;
    b.make_devices = MakeDevices;
    b.drive = procedure::DriveHob;
    b.follow = FollowRecord;
    b.planned_readings = PlannedReadings;
    b.evaluate = Evaluate;
    b.index_errors = separate::hob::HobIndexErrors;
    b.score = ScoreRun;
    b.next_runs = NextRunsOf;
    b.shift_design = ShiftsOf;
    b.diagnose = Diagnose;
    b.linear_run = Linear;
    return b;
  }();
  return bench;
}

}  // namespace twinbench::benches::hob
