#include "tests/foreign/plans.h"

#include "tests/support/thresholds.h"
#include "tests/support/twin_run.h"
#include "twin/benches/registry.h"
#include "twin/core/errors.h"
#include "twin/core/estimator.h"
#include "twin/diagnose/engine/scanner.h"

namespace twinbench::foreign {
namespace {

using diagnose::Cause, diagnose::Diagnosis, diagnose::Verdict;

bool IsNamed(const std::string& effect, const std::string& where, const std::string& name) {
  return name == effect || name == effect + " " + where;
}
bool IsAmong(const std::string& effect, const std::string& where, const Names& names) {
  return std::ranges::any_of(names, [&](const std::string& name) { return IsNamed(effect, where, name); });
}

/// That nothing tells from a cause that is there counts: an answer that is surer than that is a matter of the
/// calibration.
bool IsHonest(const Cause& cause, const Truth& truth) {
  return IsAmong(cause.effect, cause.where, truth.honest) ||
         std::ranges::any_of(truth.listed,
                             [&](const Names& names) { return IsAmong(cause.effect, cause.where, names); });
}

bool Speaks(const Diagnosis& d, const Names& names) {
  return std::ranges::any_of(d.causes, [&](const Cause& cause) {
    return IsAmong(cause.effect, cause.where, names) ||
           std::ranges::any_of(cause.indistinguishable_from,
                               [&](const diagnose::Rival& r) { return IsAmong(r.effect, r.where, names); });
  });
}

/// What is not found must be said to be there: one unknown part for each. A name that is near stands for a cause
/// that the catalogue lacks.
int MissingIn(const Diagnosis& d, const Truth& truth) {
  if (d.verdict == Verdict::kNone) return static_cast<int>(std::ssize(truth.listed)) + truth.unlisted;
  int missing = Speaks(d, truth.honest) ? std::max(0, truth.unlisted - 1) : truth.unlisted;
  for (const Names& names : truth.listed) missing += Speaks(d, names) ? 0 : 1;
  return std::max(0, missing - static_cast<int>(hidden::Split(d.unknown.signature, " | ").size()));
}

void FindWrong(const Diagnosis& d, const Truth& truth, Answer& answer) {
  if (d.verdict != Verdict::kNamed && d.verdict != Verdict::kTie) return;
  for (const Cause& cause : d.causes) {
    answer.named_near = answer.named_near || IsHonest(cause, truth);
    if (IsHonest(cause, truth) || cause.probability <= answer.wrong_at) continue;
    answer.wrong = cause.effect + (cause.where.empty() ? "" : " " + cause.where);
    answer.wrong_at = cause.probability;
  }
}

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
                   const diagnose::DiagnosisRun& found, const diagnose::DiagnoseOptions& options, Answer& answer) {
  try {
    Scenario extended = hidden::WrittenFile(machine.believed, found);
    answer.second = hidden::Says(readings, extended, options);
    if (!machine.truth.repeats) return;
    answer.second_run = hidden::Says(machine.readings(kAnother), machine.in_another_run(extended), options);
    std::erase_if(extended.empiricals, [](const EmpiricalSettings& table) { return table.by == "time"; });
    if (std::isfinite(answer.stated_gain)) answer.file_gain = GainOn(machine, extended);
  } catch (const InputError& refusal) {
    answer.second = std::string("refused: ") + refusal.what();
  }
}

}  // namespace

Answer Judge(const Truth& truth, const Diagnosis& diagnosis) {
  Answer answer;
  answer.truth = truth;
  answer.words = hidden::Judge({}, diagnosis).answer;
  answer.alarm = diagnosis.verdict != Verdict::kNone;
  answer.is_tie = diagnosis.verdict == Verdict::kTie;
  FindWrong(diagnosis, truth, answer);
  answer.missing = MissingIn(diagnosis, truth);
  answer.stated_gain = diagnosis.gain.another_run;
  return answer;
}

bool IsNamedWrongly(const Answer& a) {
  constexpr double kMoreLikelyThanNot = 0.5;
  if (a.wrong.empty()) return false;
  return a.is_tie ? !a.named_near : a.wrong_at >= kMoreLikelyThanNot;
}

bool IsRight(const Answer& a) {
  if (!a.alarm) return a.truth.IsClean() || a.truth.only_noise;
  return !a.truth.IsClean() && a.missing == 0 && !IsNamedWrongly(a);
}

std::optional<bool> IsGainRight(const Answer& a) {
  constexpr double kTolerance = 0.05;  // what a user would call the same share
  if (!std::isfinite(a.stated_gain) || !std::isfinite(a.file_gain)) return {};
  return std::abs(a.stated_gain - a.file_gain) <= kTolerance;
}

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

Answer Examine(const Plan& plan) {
  const Machine machine = plan.make();
  const std::vector<Reading> readings = machine.readings(kFirst);
  diagnose::DiagnoseOptions options;
  options.cache_folder = test::ThresholdsFolder();
  Answer answer;
  answer.truth = machine.truth;
  try {
    const diagnose::DiagnosisRun found = diagnose::Diagnose(readings, machine.believed, options);
    answer = Judge(machine.truth, found.diagnosis);
    if (answer.alarm && !machine.truth.IsClean())
      HoldToTheFile(machine, readings, found, options, answer);
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
