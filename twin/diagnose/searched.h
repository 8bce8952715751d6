#pragma once

#include <memory>
#include <vector>

#include "twin/diagnose/by_twin.h"
#include "twin/diagnose/compared.h"
#include "twin/diagnose/engine/analysis.h"
#include "twin/diagnose/twin_candidates.h"

namespace twinbench::diagnose {

/// A record compared with the twin of one scenario, and what the search makes of it.
struct Searched {
  Searched(const std::vector<Reading>& readings, const Scenario& believed, const DiagnoseOptions& options,
           const TwinComparison& comparison, Compared with_its_twin);
  Searched(const Searched&) = delete;
  Searched& operator=(const Searched&) = delete;

  const SearchResult& found() const { return analysis.found; }
  const Family& FamilyOf(const Term& term) const {
    return candidates.families[static_cast<std::size_t>(term.family)];
  }
  /// More than the first cause is needed, or something is left.
  bool LeavesStructure() const {
    return found().terms.size() > 1 || (!found().terms.empty() && found().last_statistic > analysis.threshold);
  }

  Scenario scenario;
  Compared compared;
  TwinCandidates candidates;
  Analysis analysis;
};

/// As the bench and the user want it.
AnalysisOptions HowToAnalyse(const LinearRun& run, const DiagnoseOptions& options,
                             const TwinComparison& comparison);

std::unique_ptr<Searched> SearchIn(const std::vector<Reading>& readings, const Scenario& scenario,
                                   const DiagnoseOptions& options, const TwinComparison& comparison,
                                   Compared compared);

}  // namespace twinbench::diagnose
