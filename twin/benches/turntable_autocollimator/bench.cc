#include "twin/benches/turntable_autocollimator/bench.h"

#include "twin/benches/turntable_autocollimator/estimators/index_errors.h"
#include "twin/benches/turntable_autocollimator/procedure.h"
#include "twin/benches/turntable_autocollimator/settings.h"
#include "twin/benches/turntable_autocollimator/twin/factory.h"
#include "twin/plan/next_run.h"

namespace twinbench::benches::turntable {
namespace {

int PlannedReadings(const Scenario& s) {
  return procedure::PlannedReadings(TurntableOf(s).turntable_procedure);
}

}  // namespace

const Bench& Whole() {
  static const Bench bench = [] {
    Bench b;
    b.format = &Format();
    b.make_twin = MakeTwin;
    b.follow = FollowRecord;
    b.planned_readings = PlannedReadings;
    b.evaluate = Evaluate;
    b.index_errors = separate::turntable::TurntableIndexErrors;
    b.score = ScoreRun;
    b.next_runs = NextRunsOf;
    b.diagnose = Diagnose;
    b.linear_run = Linear;
    return b;
  }();
  return bench;
}

}  // namespace twinbench::benches::turntable
