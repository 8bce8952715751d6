#include "tools/twinbench/bench_means.h"

#include "tools/twinbench/passing_run.h"
#include "twin/core/estimator.h"
#include "twin/report/evaluation.h"

namespace twinbench::tools {

investigate::Means MeansOf(const Bench& bench, const std::function<bool(const plan::NextRun&)>& may_offer,
                           const diagnose::DiagnoseOptions& how) {
  investigate::Means means;
  means.diagnose = [&bench, how](const std::vector<Reading>& readings, const Scenario& scenario,
                                 const std::vector<std::string>& struck) {
    diagnose::DiagnoseOptions options = how;
    options.excluded = struck;
    return bench.diagnose(readings, scenario, options);
  };
  means.against = [&bench](const std::vector<Reading>& readings, const Scenario& scenario) {
    return bench.linear_run(readings, scenario, Estimator::kRigorous);
  };
  means.evaluate = [&bench](const std::vector<Reading>& readings, const Scenario& scenario) {
    return bench.evaluate(scenario, readings, Estimator::kRigorous).results;
  };
  means.twin = ReadingsOfTwin;
  means.next_runs = [&bench, may_offer](const Scenario& scenario) {
    std::vector<plan::NextRun> runs;
    if (bench.next_runs) runs = bench.next_runs(scenario);
    std::erase_if(runs, [&may_offer](const plan::NextRun& run) { return !may_offer(run); });
    return runs;
  };
  return means;
}

}  // namespace twinbench::tools
