#include "tests/hidden/run_cases.h"

#include <atomic>
#include <chrono>
#include <mutex>
#include <thread>

#include "twin/benches/registry.h"
#include "twin/core/errors.h"

namespace twinbench::hidden {
namespace {

Outcome Diagnosed(const Case& hidden_case, const std::string& cache_folder) {
  diagnose::DiagnoseOptions options = hidden_case.options;
  options.cache_folder = cache_folder;
  const auto begin = std::chrono::steady_clock::now();
  Outcome outcome;
  try {
    const diagnose::DiagnosisRun run = diagnose::Diagnose(hidden_case.readings, hidden_case.scenario, options);
    outcome = Judge(hidden_case.hidden, run.diagnosis);
  } catch (const InputError& refusal) {
    outcome.hidden = hidden_case.hidden;
    outcome.answer = std::string("refused: ") + refusal.what();
  }
  outcome.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return outcome;
}

}  // namespace

Outcome RunCase(const Plan& plan, const std::string& cache_folder) {
  Outcome outcome = Diagnosed(plan.make(), cache_folder);
  outcome.set = plan.set;
  outcome.name = plan.name;
  return outcome;
}

std::vector<Outcome> RunCases(const std::vector<Plan>& plans, const RunOptions& options) {
  std::vector<Outcome> outcomes(plans.size());
  std::atomic<std::size_t> next = 0;
  std::mutex reporting;
  int done = 0;
  const auto work = [&] {
    for (std::size_t k = next++; k < plans.size(); k = next++) {
      outcomes[k] = RunCase(plans[k], options.cache_folder);
      const std::lock_guard lock(reporting);
      ++done;
      if (options.progress) options.progress(done, static_cast<int>(std::ssize(plans)), outcomes[k]);
    }
  };
  std::vector<std::thread> workers;
  for (int k = 0; k < options.threads; ++k) workers.emplace_back(work);
  for (std::thread& worker : workers) worker.join();
  return outcomes;
}

}  // namespace twinbench::hidden
