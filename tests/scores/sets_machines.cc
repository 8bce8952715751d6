#include "tests/foreign/answer.h"
#include "tests/foreign/plans.h"
#include "tests/scores/sets.h"
#include "tests/shelf/examine.h"
#include "twin/benches/names.h"

// Cases of machines that can be run again (tests/foreign), and recordings (tests/data/shelf).
namespace twinbench::scores {
namespace {

// Cases of tests/foreign: machines that can be run again.

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

// Recordings of tests/data/shelf.

void Fill(const shelf::Answer& answer, Row& row) {
  row.hidden = answer.truth;
  row.answer = (answer.judged.why.empty() || answer.judged.why == answer.words ? "" : answer.judged.why + " <- ") +
               answer.words;
  row.marks[kRight] = answer.judged.is_right;
  row.marks[kSureWrong] = answer.judged.is_sure_wrong;
  if (!answer.second) return;
  row.marks[kSecondSilent] = answer.second->empty();
  if (!answer.second->empty()) row.answer += "; again: " + *answer.second;
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

Plans ShelfSet(const std::string& bench, const Amount& amount) {
  Plans plans;
  if (bench != kEncoderBench) return plans;
  for (const std::string& name : shelf::CaseNames()) {
    plans.push_back({"shelf", bench, name, [name, cache = amount.cache_folder](Row& row) {
                       Fill(shelf::Examine(name, cache, true), row);
                     }});
  }
  return plans;
}

}  // namespace twinbench::scores
