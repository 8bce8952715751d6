#include "tools/twinbench/evaluated_run.h"

#include <fmt/core.h>

#include "tools/twinbench/analysis.h"
#include "tools/twinbench/run_folder.h"
#include "tools/twinbench/tables.h"
#include "twin/core/run_record.h"

namespace twinbench::tools {

bool EvaluateRun(const Scenario& scenario, const std::string& folder) {
  const RunFolder run{folder};
  const Analysis analysis = Analyse(scenario, RunRecord::Open(folder)->Readings(), measure::Estimator::kRigorous);
  WriteJson(run.results(), ToJson(analysis));
  fmt::print("{}", Summary(analysis));
  return analysis.separation.has_value();
}

}  // namespace twinbench::tools
