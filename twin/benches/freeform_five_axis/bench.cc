#include "twin/benches/freeform_five_axis/bench.h"

#include "twin/benches/freeform_five_axis/displacement_results.h"
#include "twin/benches/freeform_five_axis/procedure.h"
#include "twin/benches/freeform_five_axis/settings.h"
#include "twin/benches/freeform_five_axis/twin/factory.h"
#include "twin/plan/next_run.h"
#include "twin/plausible/plan.h"

namespace twinbench::benches::freeform {
namespace {

int PlannedReadings(const Scenario& scenario) {
  const FreeformProcedureSettings& p = FreeformOf(scenario).freeform_procedure;
  return 2 * p.poses * static_cast<int>(p.mounts.size());
}

/// A machine may well be faster than the interval that was thought of.
plausible::Plan PlanOf(const Scenario& s, const std::vector<Reading>&) {
  constexpr double kFaster = 4.0;
  const FreeformProcedureSettings& p = FreeformOf(s).freeform_procedure;
  return {PlannedReadings(s), p.poses, [interval_s = p.interval_s](const Reading&, const Reading&) {
            return plausible::Interval{interval_s / kFaster, plausible::AtRest(interval_s).usual_s};
          }};
}

std::unique_ptr<BenchTwin> MakeProbeTwin(const Scenario& scenario) {
  RefuseDisplacements(scenario, "simulation");
  return MakeTwin(scenario);
}

std::unique_ptr<MachineDevices> MakeProbeDevices(const Scenario& scenario) {
  RefuseDisplacements(scenario, "simulation");
  return MakeDevices(scenario);
}

std::unique_ptr<model::Follow> FollowProbe(const Scenario& scenario, const std::vector<Reading>& record) {
  RefuseDisplacements(scenario, "prediction");
  return FollowRecord(scenario, record);
}

}  // namespace

const Bench& Whole() {
  static const Bench bench = {
      .format = &Format(), .make_twin = MakeProbeTwin, .follow = FollowProbe, .planned_readings = PlannedReadings,
      .plan = PlanOf, .has_controllers = true, .make_devices = MakeProbeDevices, .drive = procedure::DriveFreeform,
      .evaluate = Evaluate, .score = ScoreRun, .next_runs = NextRunsOf, .diagnose = Diagnose, .linear_run = Linear};
  return bench;
}

}  // namespace twinbench::benches::freeform
