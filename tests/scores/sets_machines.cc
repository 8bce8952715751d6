#include "tests/foreign/answer.h"
#include "tests/foreign/plans.h"
#include "tests/scores/sets.h"
#include "twin/benches/names.h"

// Cases of tests/foreign: machines that can be run again.
namespace twinbench::scores {
namespace {

/// What a diagnosis with the written file said, where it should have been silent.
std::string Spoken(const std::string& when, const std::optional<std::string>& words) {
  return words && !words->empty() ? "; " + when + ": " + *words : "";
}

void Fill(const foreign::Answer& answer, Row& row) {
  row.hidden = answer.truth.IsClean() ? "none" : answer.truth.kind;
  row.answer = answer.words + Spoken("again", answer.second) + Spoken("another day", answer.second_run);
  row.marks[kRight] = IsRight(answer);
  row.marks[kSureWrong] = IsSurelyWrong(answer);
  if (answer.second) row.marks[kSecondSilent] = answer.second->empty();
  if (answer.second_run) row.marks[kSecondRunSilent] = answer.second_run->empty();
  row.marks[kGainRight] = IsGainRight(answer);
}

/// @param machines  Of any bench: those of the wanted one are taken.
void AppendMachines(const std::string& set, const std::string& bench, const std::string& prefix,
                    const std::vector<foreign::Plan>& machines, const std::string& cache_folder, Plans& plans) {
  for (const foreign::Plan& machine : machines) {
    if (!machine.set.ends_with(" " + bench)) continue;
    plans.push_back({set, bench, prefix + machine.name,
                     [=](Row& row) { Fill(foreign::Examine(machine, cache_folder, true), row); }});
  }
}

}  // namespace

Plans ForeignSet(const std::string& bench, const Amount& amount) {
  Plans plans;
  const int times = amount.is_long ? 4 : 1;
  AppendMachines("foreign", bench, "", foreign::KindPlans(times, amount.first_seed), amount.cache_folder, plans);
  AppendMachines("foreign", bench, "", foreign::SeveralPlans(21 * times, amount.first_seed), amount.cache_folder,
                 plans);
  AppendMachines("foreign", bench, "clean ", foreign::CleanPlans(40 * times, amount.first_seed),
                 amount.cache_folder, plans);
  return plans;
}

Plans TwoRunsSet(const std::string& bench, const Amount& amount) {
  Plans plans;
  AppendMachines("two_runs", bench, "",
                 foreign::TwinPlans(bench, amount.is_long ? 32 : 8, amount.first_seed),
                 amount.cache_folder, plans);
  return plans;
}

}  // namespace twinbench::scores
