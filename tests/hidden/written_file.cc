#include "tests/hidden/judge.h"
#include "twin/benches/circular_motion/settings.h"
#include "twin/benches/encoder_comparison/settings.h"
#include "twin/benches/freeform_five_axis/settings.h"
#include "twin/benches/hob_transmission/settings.h"
#include "twin/benches/names.h"
#include "twin/benches/registry.h"
#include "twin/benches/rotary_4dof/settings.h"
#include "twin/benches/turntable_autocollimator/settings.h"
#include "twin/core/errors.h"
#include "twin/core/happened_once.h"
#include "twin/diagnose/extend.h"

namespace twinbench::hidden {
namespace {

using units::deg;

const std::vector<int> kOtherWay = {-1, 1, 1, -1};

void Reschedule(EncoderProcedureSettings& p) {
  p.start_rad += 50.0 * deg;
  p.stop_interval_s *= 1.25;
  p.interval_s *= 1.1;
}

void Reschedule(CircularProcedureSettings& p) {
  p.start_rad += 70.0 * deg;
  p.dwell_s += 1.0;
}

}  // namespace

Scenario WrittenFile(const Scenario& believed, const diagnose::DiagnosisRun& found) {
  return ParseScenario(diagnose::ExtendedToml(believed, found, "hidden case"), "extended.toml", ".");
}

std::string Says(const std::vector<Reading>& readings, const Scenario& scenario,
                 const diagnose::DiagnoseOptions& options) {
  try {
    const diagnose::Diagnosis said = diagnose::Diagnose(readings, scenario, options).diagnosis;
    return said.verdict == diagnose::Verdict::kNone ? "" : Judge({}, said).answer;
  } catch (const InputError& refusal) {
    return std::string("refused: ") + refusal.what();
  }
}

Scenario WithOtherSchedule(Scenario scenario) {
  scenario = InRun(scenario, scenario.repeat + 1);
  const std::string& bench = scenario.bench;
  if (bench == kEncoderBench) Reschedule(EncoderOf(scenario).encoder_procedure);
  if (bench == kCircularBench) Reschedule(CircularOf(scenario).procedure);
  if (bench == kFreeformBench) FreeformOf(scenario).freeform_procedure.interval_s *= 1.25;
  if (bench == kHobBench) HobOf(scenario).hob_procedure.passes = {-1, 1};
  if (bench == kRotaryBench) RotaryOf(scenario).procedure.passes = kOtherWay;
  if (bench == kRotaryBench) RotaryOf(scenario).procedure.dwell_s = {1.5, 3.0};
  if (bench == kTurntableBench) TurntableOf(scenario).turntable_procedure.passes = kOtherWay;
  if (bench == kTurntableBench) TurntableOf(scenario).turntable_procedure.dwell_s = {1.0, 3.0};
  return scenario;
}

Scenario OnAnotherDay(const Scenario& actual) {
  Scenario another = WithOtherSchedule(actual);
  EnvironmentSettings& room = another.environment;
  room.temperature_degC += 0.6;
  room.drift_K_h = -room.drift_K_h;
  room.swing_period_s *= 1.3;
  return another;
}

}  // namespace twinbench::hidden
