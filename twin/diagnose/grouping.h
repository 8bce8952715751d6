#pragma once

#include <Eigen/Core>
#include <vector>

#include "twin/diagnose/engine/linear_run.h"

namespace twinbench::diagnose {

/// Neighbouring readings of a pass taken together: thousands of samples a pass say of most causes no more than their
/// means. Signatures are made for every reading and averaged in the same way, so nothing is approximated but what the
/// averaging takes away.
struct Grouping {
  std::vector<int> start;  // first sample of each group; the last entry is the number of samples

  Eigen::Index Groups() const { return std::ssize(start) - 1; }
  Eigen::Index Samples() const { return start.back(); }
  int Size(Eigen::Index group) const {
    return start[static_cast<std::size_t>(group + 1)] - start[static_cast<std::size_t>(group)];
  }

  /// Whether any readings are taken together at all.
  bool Averages() const { return Groups() < Samples(); }

  /// Means of each column: samples x any -> groups x any.
  Eigen::MatrixXd Mean(const Eigen::MatrixXd& samples) const;
  /// The same of rows (sample i, channel c: i * channels + c) x any.
  Eigen::MatrixXd MeanOfRows(const Eigen::MatrixXd& rows) const;
};

/// Groups of `size` samples in the order of the schedule, within set-up, pass and direction; the last of a pass may
/// be smaller.
Grouping GroupsOf(const Schedule& schedule, int size);

/// The circumstances of each group: labels of its first sample, means of the rest.
Schedule Grouped(const Schedule& schedule, const Grouping& groups);

/// Rms that the mean over groups leaves of a wave with this phase, 1 where it is slow.
double KeptByMean(const Eigen::VectorXd& phase_rad, const Grouping& groups);

/// Groups as large as leave a wave four fifths of its size, of those that leave another one half of it, if any does.
/// @param line_rad    Phase of the fastest wave that must stay.
/// @param folded_rad  Of one that is folded by the sampling, so that a larger group may leave more of it; empty: none.
Grouping LargestGroups(const Schedule& schedule, const Eigen::VectorXd& line_rad, const Eigen::VectorXd& folded_rad);

}  // namespace twinbench::diagnose
