#include "tools/twinbench/evaluated_run.h"

#include <fmt/core.h>

#include "tools/twinbench/evaluation.h"
#include "tools/twinbench/run_folder.h"
#include "twin/core/run_record.h"

namespace twinbench::tools {

bool EvaluateRun(const Scenario& scenario, const std::string& folder) {
  const RunFolder run{folder};
  const Evaluation evaluation =
      Evaluate(scenario, RunRecord::Open(folder)->Readings(), measure::Estimator::kRigorous);
  WriteJson(run.results(), evaluation.results);
  fmt::print("{}", evaluation.summary);
  return evaluation.Separated();
}

}  // namespace twinbench::tools
