#pragma once

#include <functional>
#include <string>
#include <vector>

#include "twin/diagnose/diagnose.h"
#include "twin/diagnose/engine/analysis.h"

/// From an analysis to a diagnosis: the same for every bench but for some words.
namespace twinbench::diagnose {

/// What a diagnosis says that only the bench knows.
struct AnswerWords {
  /// What a cause that this run cannot see may do to the results.
  std::function<std::string(const std::string& effect, const Eigen::VectorXd& unknowns)> bias;
  /// What would tell a cause from a rival.
  std::function<std::string(const std::string& effect, const std::string& rival)> next_measurement;
};

AnalysisOptions AnalysisOptionsOf(const DiagnoseOptions& options);
bool IsExcluded(const DiagnoseOptions& options, const std::string& effect);

/// A cause that was decided by evidence alone, before the search.
Cause DecidedCause(const std::string& effect, const std::string& where, double log_evidence);

/// Readings that are disturbed for no lasting reason.
Cause OutlierCause(const NoiseCause& noise, const LinearRun& run);

/// Names what the analysis found, says what the run would have shown and what not, and measures the gain.
/// @param first  What was decided without the analysis.
/// @throws InputError if the design has no redundancy, with the smallest addition that would help.
DiagnosisRun Conclude(const LinearRun& run, const Analysis& analysis, const std::vector<Cause>& first,
                      const AnswerWords& words);

}  // namespace twinbench::diagnose
