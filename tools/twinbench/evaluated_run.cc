#include "tools/twinbench/evaluated_run.h"

#include <fmt/core.h>

#include "tools/twinbench/run_folder.h"
#include "twin/benches/registry.h"
#include "twin/core/estimator.h"
#include "twin/core/run_record.h"
#include "twin/report/evaluation.h"

namespace twinbench::tools {

bool EvaluateRun(const Scenario& scenario, const std::string& folder) {
  const RunFolder run{folder};
  const report::Evaluation evaluation =
      BenchOf(scenario).evaluate(scenario, RunRecord::Open(folder)->Readings(), Estimator::kRigorous);
  WriteJson(run.results(), evaluation.results);
  WriteTables(folder, evaluation.tables);
  fmt::print("{}", evaluation.summary);
  return evaluation.Separated();
}

}  // namespace twinbench::tools
