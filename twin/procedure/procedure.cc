#include "twin/procedure/procedure.h"

#include <map>

#include "twin/core/errors.h"
#include "twin/procedure/sequencer.h"

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

}  // namespace

void CarryOut(RotaryBench& bench, const Scenario& scenario, ReadingSink& sink, const ProgressCallback& progress) {
  Sequencer sequencer(bench, scenario, sink, progress);
  for (const std::string& phase : scenario.procedure.phases) StepsOf(phase).carry_out(sequencer);
}

int PlannedReadings(const ProcedureSettings& procedure) {
  int readings = 0;
  for (const std::string& phase : procedure.phases) readings += StepsOf(phase).readings(procedure);
  return readings;
}

}  // namespace twinbench::procedure
