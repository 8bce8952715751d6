#pragma once

#include <memory>
#include <vector>

#include "twin/diagnose/engine/base.h"

namespace twinbench::diagnose {

/// From samples (samples x k) to rows of one channel; empty: they are the same.
using ToRows = std::function<Eigen::MatrixXd(const Eigen::MatrixXd&)>;

/// Cosine and sine of (first + number * step) phase, times a factor of each reading, for the numbers of a grid:
/// what is locked to an angle or to time.
struct WaveSeries {
  Eigen::VectorXd phase_rad;
  double first = 0.0, step = 1.0;
  std::vector<int> numbers;     // ascending, one a grid point
  Eigen::VectorXd factor = {};  // empty: one

  /// @return readings x 2.
  Eigen::MatrixXd At(int grid_point) const;
};

/// Whole numbers from 0.
std::vector<int> NumbersTo(int count);

/// On each channel alone. Where there is only one, and its rows are the readings, they are summed quickly
/// (model::WaveSums); else from tables (model::WaveGrid).
std::shared_ptr<const Base> BaseOf(const WaveSeries& waves, int channels, const ToRows& rows);

}  // namespace twinbench::diagnose
