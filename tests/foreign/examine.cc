#include <chrono>

#include "tests/foreign/answer.h"
#include "tests/support/twin_run.h"
#include "twin/benches/registry.h"
#include "twin/core/errors.h"
#include "twin/core/estimator.h"
#include "twin/diagnose/engine/scanner.h"
#include "twin/diagnose/extend.h"

namespace twinbench::foreign {
namespace {

constexpr Run kFirst{1};
constexpr Run kAnother{2, false, true};

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

/// What the second diagnosis has to say; empty if nothing.
std::string Again(const std::vector<Reading>& readings, const Scenario& extended,
                  const diagnose::DiagnoseOptions& options) {
  const diagnose::Diagnosis again = diagnose::Diagnose(readings, extended, options).diagnosis;
  return again.verdict == diagnose::Verdict::kNone ? "" : hidden::Judge({}, again).answer;
}

/// By way of the file's text, as a user has it.
void HoldToTheFile(const Machine& machine, const std::vector<Reading>& readings,
                   const diagnose::DiagnosisRun& found, const diagnose::DiagnoseOptions& options, Answer& answer) {
  answer.was_extended = true;
  try {
    const std::string text = diagnose::ExtendedToml(machine.believed, found, "foreign case");
    Scenario extended = ParseScenario(text, "extended.toml", ".");
    answer.second = Again(readings, extended, options);
    std::erase_if(extended.empiricals, [](const EmpiricalSettings& table) { return table.by == "time"; });
    if (machine.truth.repeats && std::isfinite(answer.stated_gain)) answer.file_gain = GainOn(machine, extended);
  } catch (const InputError& refusal) {
    answer.second = std::string("refused: ") + refusal.what();
  }
}

void Diagnose(const Machine& machine, const std::string& cache_folder, Answer& answer) {
  const std::vector<Reading> readings = machine.readings(kFirst);
  diagnose::DiagnoseOptions options;
  options.cache_folder = cache_folder;
  answer.truth = machine.truth;
  try {
    const diagnose::DiagnosisRun found = diagnose::Diagnose(readings, machine.believed, options);
    answer = Judge(machine.truth, found.diagnosis);
    if (answer.alarm && !machine.truth.IsClean()) HoldToTheFile(machine, readings, found, options, answer);
  } catch (const InputError& refusal) {
    answer.outcome.answer = std::string("refused: ") + refusal.what();
    answer.missing = static_cast<int>(std::ssize(machine.truth.listed)) + machine.truth.unlisted;
  }
}

}  // namespace

double GainOn(const Machine& machine, const Scenario& extended) {
  const std::vector<Reading> with = machine.readings(kAnother);
  const std::vector<Reading> without = machine.readings({kAnother.seed, false, false});
  try {
    const double before = LeftOf(with, machine.believed), floor = LeftOf(without, machine.believed);
    return (before - LeftOf(with, extended)) / (before - floor);
  } catch (const InputError&) {
    return 0.0;
  }
}

Answer Examine(const Plan& plan, const std::string& cache_folder) {
  const auto begin = std::chrono::steady_clock::now();
  Answer answer;
  Diagnose(plan.make(), cache_folder, answer);
  answer.set = answer.outcome.set = plan.set;
  answer.name = answer.outcome.name = plan.name;
  answer.outcome.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return answer;
}

}  // namespace twinbench::foreign
