#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>

#include "twin/diagnose/engine/series_sums.h"

namespace twinbench::diagnose {

/// Columns side by side; `left` may have none, and then no rows.
Eigen::MatrixXd HStack(const Eigen::MatrixXd& left, const Eigen::MatrixXd& right);

/// Every column of `series` (readings x k) on each of the channels alone: rows x channels k, the columns of channel
/// 0 first.
Eigen::MatrixXd OnEachChannel(const Eigen::MatrixXd& series, int channels);

/// From columns of OnEachChannel (k a channel) to k of each column of a pattern (channels x patterns): its weights.
Eigen::MatrixXd PatternMap(const Eigen::MatrixXd& pattern, Eigen::Index k);

/// Signatures that several families are combinations of: the same series in time on each of the channels.
struct Base {
  int grid = 1;
  int channels = 1;
  std::function<Eigen::MatrixXd(int grid_point)> series;  // readings x k
  // Of one channel only; empty: there is no quicker way. They take memory and are made for as long as they are
  // used.
  std::function<std::unique_ptr<const SeriesSums>()> sums = {};

  Eigen::MatrixXd Columns(int grid_point) const { return OnEachChannel(series(grid_point), channels); }
};

}  // namespace twinbench::diagnose
