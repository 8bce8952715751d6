#pragma once

#include <Eigen/Core>
#include <vector>

#include "twin/benches/rotary_4dof/estimators/weights.h"

/// What the exact chain reads for given unknowns, and how wrong that may be.
namespace twinbench::separate {

/// Motions of the cells for the unknowns `x` (columns of Design), lengths in kLengthUnit_m; four rows a cell.
Eigen::VectorXd PredictCells(const Design& design, const std::vector<Cell>& cells, const Eigen::VectorXd& x,
                             const BenchGeometry& geometry);

/// Second-order part of the motions [ez, ex, ey (rad), dy (m)] that the chain cannot know, one standard deviation.
///
/// The chain takes for zero what nobody reads (dx, dz) and for small what is not separable; products of these with
/// the errors that are there are missing. Angles: a^2; dy: lever a^2 + a l, with a and l the rms angle and length
/// of the separated errors and mounting constants in `x`. Measures of size, not bounds.
Vector4 UnreadSecondOrder(const Design& design, const Eigen::VectorXd& x);

}  // namespace twinbench::separate
