#pragma once

#include <Eigen/Core>
#include <vector>

#include "twin/benches/rotary_4dof/estimators/weights.h"

namespace twinbench::separate {

/// A generalised inverse of the least-squares problem's normal matrix, lengths in kLengthUnit_m.
///
/// It is that of the unknowns which are determined, plus something in the directions that change no reading; the
/// caller projects those out. Rows and columns of unknowns that no reading touches are zero.
struct NormalInverse {
  Eigen::MatrixXd inverse;      // Unknowns x Unknowns
  Eigen::MatrixXd extra_null;   // directions lost because readings are missing, one a column
  std::vector<bool> supported;  // unknowns that some reading touches

  Eigen::MatrixXd operator*(const Eigen::MatrixXd& right) const { return inverse * right; }
  void Scale(double variance) { inverse *= variance; }
};

/// Inverts the normal matrix sum of d^T W d over the stops.
///
/// A target position's four unknowns meet no other target position, so they are eliminated one by one; what remains
/// has 5 n + 8 set-ups unknowns, and costs their cube. Rank is decided on the matrix with unit diagonal: units and
/// weights of the four motions have no say in it. The known null space is pinned beforehand.
///
/// @param models      First-order model of each cell.
/// @param null_space  Directions that change no reading of a complete circle (NullSpace).
NormalInverse InvertNormal(const Design& design, const std::vector<Cell>& cells,
                           const std::vector<StopModel>& models, const Eigen::MatrixXd& null_space);

}  // namespace twinbench::separate
