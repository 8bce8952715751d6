#pragma once

#include <Eigen/Core>
#include <vector>

#include "twin/diagnose/engine/linear_run.h"

namespace twinbench::diagnose::hob {

/// Neighbouring samples of a pass taken together: thousands of samples a pass say of most causes no more than their
/// means. Signatures are made for every sample and averaged in the same way, so nothing is approximated but what
/// the averaging takes away.
struct Grouping {
  std::vector<int> start;  // first sample of each group; the last entry is the number of samples

  Eigen::Index Groups() const { return std::ssize(start) - 1; }
  Eigen::Index Samples() const { return start.back(); }
  int Size(Eigen::Index group) const {
    return start[static_cast<std::size_t>(group + 1)] - start[static_cast<std::size_t>(group)];
  }

  /// Means of each column: samples x any -> groups x any.
  Eigen::MatrixXd Mean(const Eigen::MatrixXd& samples) const;
};

/// Groups of `size` samples in the order of the schedule, within set-up, pass and direction; the last of a pass may
/// be smaller.
Grouping GroupsOf(const Schedule& schedule, int size);

/// The circumstances of each group: labels of its first sample, means of the rest.
Schedule Grouped(const Schedule& schedule, const Grouping& groups);

/// Rms that the mean over groups leaves of a wave with this phase, 1 where it is slow.
double KeptByMean(const Eigen::VectorXd& phase_rad, const Grouping& groups);

}  // namespace twinbench::diagnose::hob
