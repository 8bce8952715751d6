#pragma once

#include <cstddef>
#include <vector>

#include "twin/benches/rotary_4dof/estimators/design.h"

/// How much each reading counts: samples with their covariances, summed over what was read at the same stop.
namespace twinbench::separate {

/// One stop of one set-up: all readings taken there, with their summed weight.
struct Cell {
  int setup = 0;
  int target = 0;
  Matrix4 weight = Matrix4::Zero();  // inverse covariance, lengths in kLengthUnit_m
};

struct Weights {
  bool covariance_known = true;      // false: equal noise on all PSD axes is assumed
  std::vector<Matrix4> sample_cov;   // of each sample as weighted, lengths in kLengthUnit_m
  std::vector<std::size_t> cell_of;  // of each sample
  std::vector<Cell> cells;
};

/// Factors that bring a motion vector [ez, ex, ey (rad), dy (m)] to kLengthUnit_m.
Vector4 UnitScale();

/// Sums the readings' weights over the stops. A reading has the mean covariance of its pass and set-up: its own
/// deviation is a noisy weight (7 % for 100 samples). If any reading states none, all get AssumedCovariance.
/// @param scale  Factors on the readings' standard uncertainties by motion [ez, ex, ey, dy].
Weights CollectWeights(const std::vector<Motion>& motions, const Layout& layout, const BenchGeometry& geometry,
                       const Vector4& scale);

/// Covariance [rad^2, rad m, m^2] that 0.3 um on every PSD axis would give, for readings that state none.
Matrix4 AssumedCovariance(const BenchGeometry& geometry);

/// Weighted mean of the values of each cell's samples, four rows a cell.
/// @param of_sample  4 x columns values of sample k, lengths in kLengthUnit_m.
template <typename Values>
Eigen::MatrixXd CellMeans(const Weights& weights, Eigen::Index columns, const Values& of_sample) {
  Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(measure::kDofs * std::ssize(weights.cells), columns);
  const auto rows = [&sums](std::size_t cell) {
    return sums.middleRows<measure::kDofs>(measure::kDofs * static_cast<Eigen::Index>(cell));
  };
  for (std::size_t k = 0; k < weights.cell_of.size(); ++k) {
    rows(weights.cell_of[k]) += weights.sample_cov[k].inverse() * of_sample(k);
  }
  for (std::size_t c = 0; c < weights.cells.size(); ++c) {
    rows(c) = Eigen::MatrixXd(weights.cells[c].weight.inverse() * rows(c));
  }
  return sums;
}

}  // namespace twinbench::separate
