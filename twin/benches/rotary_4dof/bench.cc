#include "twin/benches/rotary_4dof/bench.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "twin/benches/rotary_4dof/procedure/procedure.h"
#include "twin/benches/rotary_4dof/settings.h"
#include "twin/benches/rotary_4dof/twin/factory.h"
#include "twin/plan/shift_sets.h"
#include "twin/plan/next_run.h"
#include "twin/plausible/plan.h"

namespace twinbench::benches::rotary {
namespace {

int PlannedReadings(const Scenario& s) {
  return procedure::PlannedReadings(RotaryOf(s).procedure);
}

plausible::Plan PlanOf(const Scenario& s, const std::vector<Reading>&) {
  const ProcedureSettings& p = RotaryOf(s).procedure;
  return {PlannedReadings(s), p.positions, [dwells_s = p.dwell_s](const Reading&, const Reading& here) {
            return plausible::BesideDwell(dwells_s, here);
          }};
}

plan::ShiftDesign ShiftsOf(const Scenario& s) {
  const ProcedureSettings& p = RotaryOf(s).procedure;
  plan::ShiftDesign design{p.positions, p.shifts, [](const std::vector<int>& shifts) {
                             return std::vector<std::string>{
                                 fmt::format("procedure.shifts=[{}]", fmt::join(shifts, ", "))};
                           }};
  if (p.clamping == "reclamp")
    design.other_ways = {{"reseated",
                          "the same mountings, the reference's body turned back on the target instead of the grating on it",
                          {"procedure.clamping=reseat"},
                          plan::kSameKind}};
  return design;
}

}  // namespace

const Bench& Whole() {
  static const Bench bench = {
      .format = &Format(), .make_twin = MakeTwin, .follow = FollowRecord, .planned_readings = PlannedReadings,
      .plan = PlanOf, .is_pictured = true, .has_controllers = true, .evaluate = Evaluate, .score = ScoreRun,
      .index_errors = IndexErrorsOf, .contributions = Contributions, .shift_design = ShiftsOf,
      .next_runs = NextRunsOf, .diagnose = Diagnose, .linear_run = Linear, .change_of_tables = ChangeOfTables};
  return bench;
}

}  // namespace twinbench::benches::rotary
