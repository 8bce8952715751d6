#include "twin/benches/rotary_4dof/procedure/procedure.h"

#include <map>

#include "twin/benches/rotary_4dof/procedure/sequencer.h"
#include "twin/benches/rotary_4dof/settings.h"
#include "twin/core/device_fault.h"
#include "twin/procedure/attempts.h"
#include "twin/procedure/watch.h"

namespace twinbench::procedure {
namespace {

struct PhaseSteps {
  void (*carry_out)(Sequencer&);
  int (*readings)(const ProcedureSettings&);
};

const PhaseSteps& StepsOf(const std::string& phase) {
  static const std::map<std::string, PhaseSteps> steps = {{"calibration", {Calibrate, CalibrationReadings}},
                                                          {"stability", {TestStability, StabilityReadings}},
                                                          {"verification", {Verify, VerificationReadings}},
                                                          {"full_circle", {TestFullCircle, FullCircleReadings}}};
  const auto found = steps.find(phase);
  Require(found != steps.end(), "procedure.phases holds a phase that does not exist");
  return found->second;
}

void CarryOutPhases(Sequencer&& sequencer, const ProcedureSettings& procedure) {
  sequencer.Begin();
  for (const std::string& phase : procedure.phases) StepsOf(phase).carry_out(sequencer);
}

}  // namespace

void CarryOut(RotaryBench& bench, const Scenario& scenario, ReadingSink& sink, const ProgressCallback& progress,
              const Options& options) {
  Journal journal(bench, options.log, options.calls_done);
  RunState state{static_cast<int>(options.kept.size()), {}, false};
  Attempts attempts(options.attempts);
  for (;;) {
    try {
      return CarryOutPhases(Sequencer(journal, scenario, sink, options, progress, state),
                            RotaryOf(scenario).procedure);
    } catch (const DeviceFault& fault) {
      if (options.hear_fault) options.hear_fault(fault);
      const Standstill stands = StopBoth(bench, options);
      journal.Forget();
      state.disturbed = true;
      state.moved = fault.kind() == FaultKind::kMoved || fault.kind() == FaultKind::kNotInPosition;
      NoteFailure(options.log, state.kept, bench.clock.Now(), fault);
      const bool knows_the_way = journal.kept();
      if (!knows_the_way || !stands.is_sure || !IsWorthAnotherAttempt(fault.kind()) || !attempts.AnotherAt(state.kept))
        throw StoppedRun(fault, stands);
    } catch (...) {  // whatever it is, no table goes on moving
      StopBoth(bench, options);
      throw;
    }
  }
}

int PlannedReadings(const ProcedureSettings& procedure) {
  int readings = 0;
  for (const std::string& phase : procedure.phases) readings += StepsOf(phase).readings(procedure);
  return readings;
}

}  // namespace twinbench::procedure
