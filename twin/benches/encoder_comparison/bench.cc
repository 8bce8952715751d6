#include "twin/benches/encoder_comparison/bench.h"

#include "twin/benches/encoder_comparison/twin/twin.h"
#include "twin/procedure/angle_comparison.h"

namespace twinbench::benches::encoder {
namespace {

int PlannedReadings(const Scenario& s) {
  return static_cast<int>(procedure::AngleSchedule(s.encoder_procedure).size());
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
    b.score = ScoreRun;
    b.diagnose = Diagnose;
    b.linear_run = Linear;
    return b;
  }();
  return bench;
}

}  // namespace twinbench::benches::encoder
