#pragma once

#include <Eigen/Core>
#include <vector>

#include "twin/benches/hob_transmission/estimators/transmission_error.h"

namespace twinbench::separate::hob {

/// One signal over one pass.
struct Pass {
  int setup = 0;
  int pass = 0;
  int direction = 1;
  double head_rad = kNaN;
  std::vector<double> th_rad;
  std::vector<double> value_rad;
  std::vector<double> hob_rad;
};

/// One turn of a pass, counted from the pass's first sample; the last one may be a part of a turn.
struct Turn {
  int index = 0;
  double middle_rad = kNaN;
  Eigen::VectorXd th_rad;
  Eigen::VectorXd value_rad;
};

/// Sorts the samples that have this signal into passes: ascending set-up, direction +1 first, ascending pass.
/// @throws InputError as MeasurePositions.
std::vector<Pass> SortPasses(const std::vector<HobSample>& samples, const TransmissionOptions& options,
                             Signal signal);

std::vector<Turn> CutIntoTurns(const Pass& pass);

}  // namespace twinbench::separate::hob
