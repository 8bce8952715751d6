#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "twin/diagnose/engine/family.h"
#include "twin/diagnose/engine/linear_run.h"
#include "twin/diagnose/engine/noise_model.h"
#include "twin/diagnose/engine/projector.h"
#include "twin/diagnose/engine/scan_kernels.h"

namespace twinbench::diagnose {

/// Whitened rows x any as unwhitened signatures meet them: S'Y = raw' F'Y with F the whitening. So signatures need
/// not be whitened for every scan, and a series that shows on each channel need not be written out four times.
class Unwhitened {
 public:
  Unwhitened(const LinearRun& run, const NoiseModel& noise, const Eigen::MatrixXd& white);

  const Eigen::MatrixXd& Rows() const { return rows_; }  // F'Y
  const RunsByRow& ByRow() const { return by_row_; }     // the same
  const RunsByRow& Channel(int c) const {                // readings x any
    return channel_.empty() ? by_row_ : channel_[static_cast<std::size_t>(c)];
  }

 private:
  Eigen::MatrixXd rows_;
  RunsByRow by_row_;
  std::vector<RunsByRow> channel_;  // empty: the only one has all rows
};

/// Families that share their columns, with what depends on the design only. Grid points come in chunks that fit
/// into the processor's cache, or all at once where their sums need no columns.
class Bundle {
 public:
  /// @param members    Indices of the families.
  /// @param kept_left  How many values may still be kept instead of made again at each scan; lowered by those that
  /// are.
  Bundle(const LinearRun& run, const NoiseModel& noise, const Projector& projector,
         const std::vector<Family>& families, std::vector<int> members, Eigen::Index& kept_left);

  const std::vector<int>& Members() const { return members_; }
  int Grid() const { return grid_; }
  int Columns() const { return columns_; }                                                 // a grid point
  int Step() const { return step_; }                                                       // grid points a chunk
  const Eigen::MatrixXd& Gram(int g) const { return gram_[static_cast<std::size_t>(g)]; }  // S'WS
  const Eigen::MatrixXd& Raw(int g) const { return raw_[static_cast<std::size_t>(g)]; }    // S'S

  /// S'Y of all grid points of one chunk: their columns one after the other x columns of Y.
  RunsByRow Products(int chunk, const Unwhitened& Y) const;

 private:
  void SumUp(const LinearRun& run, const NoiseModel& noise, const Projector& projector);
  void WriteOut(const LinearRun& run, const NoiseModel& noise, const Projector& projector, Eigen::Index& kept_left);
  Eigen::MatrixXd Make(int chunk) const;  // series, or signatures of a family of its own, not whitened

  const Family& family_;  // one of the members
  std::unique_ptr<const SeriesSums> sums_;
  std::vector<int> members_;
  int grid_, columns_, step_;
  std::vector<Eigen::MatrixXd> gram_, raw_;
  std::vector<Eigen::MatrixXd> kept_;  // of the first chunks
};

}  // namespace twinbench::diagnose
