#include "tests/foreign/answer.h"
#include "tests/hidden/written_file.h"
#include "tests/support/twin_run.h"
#include "twin/benches/registry.h"
#include "twin/core/errors.h"
#include "twin/core/estimator.h"
#include "twin/diagnose/engine/scanner.h"

namespace twinbench::foreign {
namespace {

/// The run as the bench sees it, and without faults in place of its noise the noise that the bench believes in:
/// three fits of one run are compared, so that its size cancels.
diagnose::LinearRun LinearOf(const std::vector<Reading>& readings, const Scenario& scenario) {
  diagnose::LinearRun run = BenchOf(scenario).linear_run(readings, scenario, Estimator::kRigorous);
  constexpr double kAny_rad = 1e-5;
  if (!run.sigma_stated) run.sigma.setConstant(kAny_rad);
  return run;
}

double LeftOf(const std::vector<Reading>& readings, const Scenario& scenario) {
  return diagnose::FreeMisfit(LinearOf(readings, scenario)).power;
}

void HoldToTheFile(const Machine& machine, const std::vector<Reading>& readings,
                   const diagnose::DiagnosisRun& found, const diagnose::DiagnoseOptions& options, bool runs_again,
                   Answer& answer) {
  try {
    Scenario extended = hidden::WrittenFile(machine.believed, found);
    answer.second = hidden::Says(readings, extended, options);
    if (!machine.truth.repeats) return;
    if (runs_again)
      answer.second_run = hidden::Says(machine.readings(kAnother), machine.in_another_run(extended), options);
    std::erase_if(extended.empiricals, [](const EmpiricalSettings& table) { return table.by == "time"; });
    if (std::isfinite(answer.stated_gain)) answer.file_gain = GainOn(machine, extended);
  } catch (const InputError& refusal) {
    answer.second = std::string("refused: ") + refusal.what();
  }
}

}  // namespace

double GainOn(const Machine& machine, const Scenario& extended) {
  const std::vector<Reading> with = machine.readings(kAnotherWithoutNoise);
  const std::vector<Reading> without = machine.readings({kAnother.seed, false, false});
  const Scenario believed = machine.in_another_run(machine.believed);
  try {
    const double before = LeftOf(with, believed), floor = LeftOf(without, believed);
    return (before - LeftOf(with, machine.in_another_run(extended))) / (before - floor);
  } catch (const InputError&) {
    return 0.0;
  }
}

Answer Examine(const Plan& plan, const std::string& cache_folder, bool runs_again) {
  const Machine machine = plan.make();
  const std::vector<Reading> readings = machine.readings(kFirst);
  diagnose::DiagnoseOptions options;
  options.cache_folder = cache_folder;
  Answer answer;
  answer.truth = machine.truth;
  try {
    const diagnose::DiagnosisRun found = diagnose::Diagnose(readings, machine.believed, options);
    answer = Judge(machine.truth, found.diagnosis);
    if (answer.alarm && !machine.truth.IsClean())
      HoldToTheFile(machine, readings, found, options, runs_again, answer);
  } catch (const InputError& refusal) {
    answer.words = std::string("refused: ") + refusal.what();
    answer.missing = static_cast<int>(std::ssize(machine.truth.listed)) + machine.truth.unlisted;
    answer.alarm = true;
  }
  answer.set = plan.set;
  answer.name = plan.name;
  return answer;
}

}  // namespace twinbench::foreign
