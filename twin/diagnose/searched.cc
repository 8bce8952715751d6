#include "twin/diagnose/searched.h"

#include <algorithm>
#include <utility>

#include "twin/diagnose/conclusion.h"

namespace twinbench::diagnose {
namespace {

/// Simulated runs without effect: fewer where a run has many rows.
int NullRuns(const LinearRun& run, int wanted) {
  constexpr int kFewest = 150;
  constexpr double kRows = 1e6;  // of all simulated runs
  return std::min(wanted, std::max(static_cast<int>(kRows / run.Rows()), kFewest));
}

}  // namespace

Searched::Searched(const std::vector<Reading>& readings, const Scenario& believed, const DiagnoseOptions& options,
                   const TwinComparison& comparison, Compared with_its_twin)
    : scenario(believed),
      compared(std::move(with_its_twin)),
      candidates(CandidatesOf(compared, readings, scenario, options, comparison)) {}

AnalysisOptions HowToAnalyse(const LinearRun& run, const DiagnoseOptions& options,
                             const TwinComparison& comparison) {
  AnalysisOptions how = AnalysisOptionsOf(options);
  how.most_causes = comparison.most_causes;
  how.bent = comparison.bent;
  how.together = comparison.together;
  if (comparison.sampled) how.null_runs = NullRuns(run, options.null_runs);
  return how;
}

std::unique_ptr<Searched> SearchIn(const std::vector<Reading>& readings, const Scenario& scenario,
                                   const DiagnoseOptions& options, const TwinComparison& comparison,
                                   Compared compared) {
  auto searched = std::make_unique<Searched>(readings, scenario, options, comparison, std::move(compared));
  searched->analysis = Analyse(searched->compared.run, searched->candidates.families,
                               HowToAnalyse(searched->compared.run, options, comparison));
  return searched;
}

}  // namespace twinbench::diagnose
