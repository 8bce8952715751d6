#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <cstdint>
#include <vector>

#include "twin/diagnose/engine/linear_run.h"
#include "twin/diagnose/engine/noise_model.h"
#include "twin/diagnose/engine/projector.h"

namespace twinbench::diagnose::screen {

/// Readings x readings: noise has no memory across channels.
using Whitening = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// The residual of a run beside those of simulated runs without effect on the same design. Column 0 is the run, the
/// others are nulls; every statistic is computed for all columns by the same code, and the nulls give its p-value.
struct Sample {
  const LinearRun& run;
  const Projector& projector;
  std::vector<Whitening> whitening;      // one a channel
  Eigen::VectorXd redundancy;            // by row: what projection leaves of the variance
  Eigen::MatrixXd residual;              // rows x columns, whitened and projected
  Eigen::MatrixXd levelled;              // the same, each channel of each column divided by its rms
  Eigen::VectorXd level;                 // rms of the run's channels in units of the stated noise
  std::vector<Eigen::MatrixXd> adjoint;  // one a channel, readings x columns: transposed whitening of levelled

  int Columns() const { return static_cast<int>(residual.cols()); }
  /// What one unit of `levelled` typically is on a channel of the run, SI.
  double Unit_SI(int channel) const;
};

/// Simulates the nulls: white noise, and unknowns drawn from their priors (a calibrated gain is never exactly its
/// prior mean), projected like the run. Priors much wider than what the rows can tell are cut: projection removes
/// them, and wide draws would only cost digits.
Sample Simulate(const LinearRun& run, const NoiseModel& noise, const Projector& projector, int null_runs,
                std::uint64_t seed);

}  // namespace twinbench::diagnose::screen
