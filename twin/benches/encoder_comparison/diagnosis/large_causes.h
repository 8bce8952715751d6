#pragma once

#include <memory>
#include <vector>

#include "twin/benches/encoder_comparison/diagnosis/large_cause.h"
#include "twin/benches/encoder_comparison/diagnosis/second_order.h"

/// Causes so large that a search to first order does not do: each is given to the twin, all of them are fitted
/// together by asking it, and what is left is searched again.
namespace twinbench::diagnose::encoder {

struct LargeCauses {
  std::unique_ptr<Searched> first;  // as if nothing were large
  std::unique_ptr<Searched> last;   // the large ones in the twin, their parameters free; the same if there is none
  std::vector<LargeCause> causes;   // in the order in which they were found
  Eigen::MatrixXd targets;          // whose errors are free (stop_errors.h): rows x targets; empty: none are
  double left = 0.0;                // power that they leave, in units of the first noise
  double named_left = 0.0;          // that all that has a name leaves
  double memory = 1.0;              // of that (memory.h)
  SecondOrder bent;                 // of the large causes, and of those that a diagnosis has found before

  const Searched& Last() const { return last ? *last : *first; }
};

/// @throws InputError as BuildRun does.
LargeCauses FindLargeCauses(const std::vector<Reading>& readings, const Scenario& scenario,
                            const DiagnoseOptions& options, const model::FollowMaker& follow);

/// The large causes before the others, and the gain of all.
void AddLargeCauses(const LargeCauses& large, DiagnosisRun& result);

}  // namespace twinbench::diagnose::encoder
