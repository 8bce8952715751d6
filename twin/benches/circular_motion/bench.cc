#include "twin/benches/circular_motion/bench.h"

#include "twin/benches/circular_motion/procedure.h"
#include "twin/benches/circular_motion/procedure/drive.h"
#include "twin/benches/circular_motion/twin/factory.h"
#include "twin/plan/next_run.h"

namespace twinbench::benches::circular {
namespace {

int PlannedReadings(const Scenario& s) {
  return static_cast<int>(procedure::CircleSchedule(CircularOf(s).procedure).size());
}

}  // namespace

const Bench& Whole() {
  static const Bench bench = [] {
    Bench b;
    b.format = &Format();
    b.make_twin = MakeTwin;
    b.has_controllers = true;
    b.make_devices = MakeDevices;
    b.drive = procedure::DriveCircles;
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

}  // namespace twinbench::benches::circular
