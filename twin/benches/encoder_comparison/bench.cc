#include "twin/benches/encoder_comparison/bench.h"

#include "twin/benches/encoder_comparison/procedure.h"
#include "twin/benches/encoder_comparison/procedure/drive.h"
#include "twin/benches/encoder_comparison/settings.h"
#include "twin/benches/encoder_comparison/twin/factory.h"
#include "twin/plan/next_run.h"

namespace twinbench::benches::encoder {
namespace {

int PlannedReadings(const Scenario& s) {
  return static_cast<int>(procedure::AngleSchedule(EncoderOf(s).encoder_procedure).size());
}

}  // namespace

const Bench& Whole() {
  static const Bench bench = [] {
    Bench b;
    b.format = &Format();
    b.make_twin = MakeTwin;
    b.has_controllers = true;
    b.make_devices = MakeDevices;
    b.drive = procedure::DriveComparison;
    b.follow = FollowRecord;
    b.planned_readings = PlannedReadings;
    b.evaluate = Evaluate;
    b.index_errors = IndexErrorsOf;
    b.score = ScoreRun;
    b.next_runs = NextRunsOf;
    b.shift_design = ShiftsOf;
    b.diagnose = Diagnose;
    b.linear_run = Linear;
    return b;
  }();
  return bench;
}

}  // namespace twinbench::benches::encoder
