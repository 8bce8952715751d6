#pragma once

#include <Eigen/Core>
#include <vector>

#include "twin/benches/rotary_4dof/estimators/design.h"

/// On an even grid with a constant shift a set-up couples only equal orders of the unknown series, so that a design
/// of complete circles falls into small real blocks. docs/theory.md 3, 4, 11.5.
namespace twinbench::separate {

/// cos and sin of one order over the grid, each of unit length; order 0 and n/2 have the cosine only.
struct OrderBasis {
  int order = 0;
  int parts = 2;
  double cos_scale = 1.0;  // length of the sampled cosine: sqrt(n/2), or sqrt(n) when alone

  OrderBasis(int m, int n);
};

/// One order of the first-order model: readings' coefficients (row (4 setup + motion) parts + part) from those of
/// the unknowns (column series * parts + part, then the constants that look like this order: mounts at order 0,
/// seats at order 1).
struct OrderBlock {
  OrderBasis basis;
  Eigen::MatrixXd d;
  std::vector<int> constant_columns;  // of Design
  Eigen::MatrixXd null;               // orthonormal columns that change no reading
};

/// Blocks of the orders 0 to n/2.
std::vector<OrderBlock> OrderBlocks(const Design& design);

/// Orthonormal basis of the directions in the unknowns (columns of Design, lengths in kLengthUnit_m) that change no
/// reading of a complete full circle.
Eigen::MatrixXd NullSpace(const Design& design, const std::vector<OrderBlock>& blocks);

}  // namespace twinbench::separate
