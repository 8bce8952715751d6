#include "tests/hidden/judge.h"
#include "tests/hidden/unlisted_cause.h"
#include "tests/scores/sets.h"
#include "tests/support/thresholds.h"
#include "tests/support/twin_run.h"
#include "twin/benches/names.h"
#include "twin/benches/registry.h"

// Cases of tests/hidden: one run, what is hidden in it, and what the written file says of the same readings.
namespace twinbench::scores {
namespace {

using hidden::Outcome;

/// Whether an answer is right: as the suite has it, or as a set has it.
using RightIf = bool (*)(const Outcome&);

/// Of an effect that is struck from the catalogue nothing else is right than to say that it is unknown.
bool IsUnknown(const Outcome& o) {
  return o.verdict == diagnose::Verdict::kUnknown;
}

void Examine(const hidden::Case& made, RightIf is_right, Row& row) {
  diagnose::DiagnoseOptions options = made.options;
  options.cache_folder = test::ThresholdsFolder();
  row.hidden = InWords(made.hidden);
  const diagnose::DiagnosisRun found = diagnose::Diagnose(made.readings, made.scenario, options);
  const Outcome outcome = Judge(made.hidden, found.diagnosis);
  row.answer = outcome.answer;
  row.marks[kRight] = is_right(outcome);
  row.marks[kSureWrong] = outcome.sure_wrong;
  const bool is_written =
      outcome.verdict != diagnose::Verdict::kNone && !made.hidden.IsClean() && options.excluded.empty();
  if (!is_written) return;
  const std::string again = hidden::Says(made.readings, hidden::WrittenFile(made.scenario, found), options);
  row.marks[kSecondSilent] = again.empty();
  if (!again.empty()) row.answer += "; again: " + again;
}

/// @param prefix  Of names, where a set has several sorts of cases.
void AppendCases(const std::string& set, const std::string& bench, const std::string& prefix,
                 const std::vector<hidden::Plan>& cases, Plans& plans, RightIf is_right = hidden::IsRight) {
  for (const hidden::Plan& one : cases) {
    plans.push_back({set, bench, prefix + one.name, [=, make = one.make](Row& row) { Examine(make(), is_right, row); }});
  }
}

/// Sooner and later than the ten minutes that both benches' scenarios believe.
const std::vector<hidden::Clamped> kClamped = {{30.0, 60.0},  {30.0, 300.0},  {120.0, 60.0},   {120.0, 300.0},
                                               {600.0, 60.0}, {3600.0, 60.0}, {3600.0, 600.0}, {7200.0, 300.0}};

hidden::TwinOptions TwinOptionsOf(const Amount& amount, double rho_from, double rho_to) {
  return {.magnitudes = amount.is_long ? 2 : 1, .seeds = amount.is_long ? 2 : 1, .first_seed = amount.first_seed,
          .rho_from = rho_from, .rho_to = rho_to};
}

}  // namespace

Plans HiddenSet(const std::string& bench, const Amount& amount) {
  // 5 to 30: in the standard set their middle, 12.
  const hidden::TwinOptions options = TwinOptionsOf(amount, 5.0, 30.0);
  Plans plans;
  const auto append = [&](const std::string& prefix, const std::vector<hidden::Plan>& cases) {
    AppendCases("hidden", bench, prefix, cases, plans);
  };
  append("", SinglePlans(bench, options));
  if (bench == kRotaryBench || bench == kTurntableBench)
    append("clamped ", CreepPlans(bench, kClamped, TwinOptionsOf(amount, 20.0, 20.0)));
  if (bench == kRotaryBench) append("pair ", hidden::PairPlans(amount.is_long ? 40 : 10, options));
  return plans;
}

Plans ChallengeSet(const std::string& bench, const Amount&) {
  Plans plans;
  const std::string folder = test::DataPath(hidden::ChallengeSetOf(bench));
  if (std::filesystem::is_directory(folder))
    AppendCases("challenge", bench, "", hidden::ChallengePlans(folder, bench), plans);
  return plans;
}

Plans CleanSet(const std::string& bench, const Amount& amount) {
  Plans plans;
  const int count = (amount.is_long ? 8 : 2) * hidden::kNoises;
  AppendCases("clean", bench, "", hidden::CleanPlans(bench, count, amount.first_seed), plans);
  return plans;
}

Plans UnlistedSet(const std::string& bench, const Amount& amount) {
  const hidden::TwinOptions options = TwinOptionsOf(amount, 20.0, 20.0);
  Plans plans;
  AppendCases("unlisted", bench, "", UnlistedPlans(bench, options), plans);
  // Every design without an effect is calibrated for itself: a sample, unless there is a night.
  const auto some = hidden::Every(amount.is_long ? 3 : 10, LeaveOneOutPlans(bench, options));
  AppendCases("unlisted", bench, "struck ", some, plans, IsUnknown);
  return plans;
}

const std::vector<Set>& Sets() {
  static const std::vector<Set> sets = {
      {"hidden", "every effect at every place, by the twin; pairs; mounts that creep", HiddenSet},
      {"challenge", "cases of independent generators, tests/data/challenge*", ChallengeSet},
      {"foreign", "machines that share nothing with the program: causes without a name, several at once",
       ForeignSet},
      {"two_runs", "a first run is diagnosed, its written file predicts another day's run of the same machine",
       TwoRunsSet},
      {"own_scenario", "a run of the twin with its own scenario, key by key and effect by effect: silence is right",
       OwnScenarioSet},
      {"investigate", "one hidden cause, with as many runs as it takes", InvestigateSet},
      {"clean", "nothing wrong, the noise odd: silence is right", CleanSet},
      {"unlisted", "causes that the catalogue lacks, and effects struck from it", UnlistedSet},
      {"shelf", "recordings as people have them, imported by a plain guess: tests/data/shelf", ShelfSet}};
  return sets;
}

}  // namespace twinbench::scores
