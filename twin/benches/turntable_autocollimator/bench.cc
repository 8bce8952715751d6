#include "twin/benches/turntable_autocollimator/bench.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "twin/benches/turntable_autocollimator/estimators/index_errors.h"
#include "twin/benches/turntable_autocollimator/procedure.h"
#include "twin/benches/turntable_autocollimator/settings.h"
#include "twin/benches/turntable_autocollimator/twin/factory.h"
#include "twin/plan/shift_sets.h"
#include "twin/plausible/plan.h"

namespace twinbench::benches::turntable {
namespace {

int PlannedReadings(const Scenario& s) {
  return procedure::PlannedReadings(TurntableOf(s).turntable_procedure);
}

plausible::Plan PlanOf(const Scenario& s, const std::vector<Reading>&) {
  const TurntableProcedureSettings& p = TurntableOf(s).turntable_procedure;
  return {PlannedReadings(s), p.positions, [dwells_s = p.dwell_s](const Reading&, const Reading& here) {
            return plausible::BesideDwell(dwells_s, here);
          }};
}

/// One value a set-up, the scenario's in turn.
std::string InTurn(const char* key, const std::vector<double>& values, double unit, std::size_t count) {
  std::vector<double> taken;
  for (std::size_t k = 0; k < count; ++k) taken.push_back(values[k % values.size()] / unit);
  return fmt::format("turntable_procedure.{}=[{:.9g}]", key, fmt::join(taken, ", "));
}

/// Of the multi-tooth table, in stops of the turntable.
plan::ShiftDesign ShiftsOf(const Scenario& s) {
  const TurntableProcedureSettings& p = TurntableOf(s).turntable_procedure;
  const int teeth_a_stop = TurntableOf(s).multitooth.teeth / p.positions;
  plan::ShiftDesign design;
  design.positions = p.positions;
  for (int setup = 0; setup < p.SetUps(); ++setup) design.shifts.push_back(p.Of(p.shifts, setup) / teeth_a_stop);
  design.sets = [p, teeth_a_stop](const std::vector<int>& shifts) {
    std::vector<int> teeth = shifts;
    for (int& shift : teeth) shift *= teeth_a_stop;
    return std::vector<std::string>{
        fmt::format("turntable_procedure.shifts_teeth=[{}]", fmt::join(teeth, ", ")),
        InTurn("tilts_arcsec", p.tilts_rad, units::arcsec, shifts.size()),
        InTurn("tilt_azimuths_deg", p.tilt_azimuths_rad, units::deg, shifts.size()),
        InTurn("eccentricities_um", p.eccentricities_m, units::um, shifts.size())};
  };
  return design;
}

}  // namespace

const Bench& Whole() {
  static const Bench bench = {
      .format = &Format(), .make_twin = MakeTwin, .follow = FollowRecord, .planned_readings = PlannedReadings,
      .plan = PlanOf, .has_controllers = true, .make_devices = MakeDevices, .drive = procedure::DriveTurntable,
      .evaluate = Evaluate, .score = ScoreRun, .index_errors = separate::turntable::TurntableIndexErrors,
      .shift_design = ShiftsOf, .next_runs = NextRunsOf, .diagnose = Diagnose, .linear_run = Linear};
  return bench;
}

}  // namespace twinbench::benches::turntable
