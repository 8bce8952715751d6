#include "tests/hidden/run_cases.h"

#include <algorithm>
#include <atomic>
#include <thread>

#include "twin/benches/registry.h"
#include "twin/core/errors.h"

namespace twinbench::hidden {
namespace {

Outcome Diagnosed(const Case& hidden_case, const RunOptions& run) {
  diagnose::DiagnoseOptions options = hidden_case.options;
  options.cache_folder = run.cache_folder;
  options.null_runs = std::min(options.null_runs, run.most_null_runs);
  try {
    return Judge(hidden_case.hidden,
                 diagnose::Diagnose(hidden_case.readings, hidden_case.scenario, options).diagnosis);
  } catch (const InputError& refusal) {
    Outcome outcome;
    outcome.hidden = hidden_case.hidden;
    outcome.answer = std::string("refused: ") + refusal.what();
    return outcome;
  }
}

}  // namespace

void InParallel(std::size_t count, int threads, const std::function<void(std::size_t)>& work) {
  std::atomic<std::size_t> next = 0;
  std::vector<std::thread> workers;
  for (int t = 0; t < threads; ++t) {
    workers.emplace_back([&] {
      for (std::size_t k = next++; k < count; k = next++) work(k);
    });
  }
  for (std::thread& worker : workers) worker.join();
}

Outcome RunCase(const Plan& plan, const RunOptions& options) {
  Outcome outcome = Diagnosed(plan.make(), options);
  outcome.set = plan.set;
  outcome.name = plan.name;
  return outcome;
}

std::vector<Outcome> RunCases(const std::vector<Plan>& plans, const RunOptions& options) {
  std::vector<Outcome> outcomes(plans.size());
  InParallel(plans.size(), options.threads, [&](std::size_t k) { outcomes[k] = RunCase(plans[k], options); });
  return outcomes;
}

}  // namespace twinbench::hidden
