#pragma once

#include <Eigen/Core>
#include <vector>

#include "twin/benches/rotary_4dof/estimators/separability.h"

namespace twinbench::separate {

/// Null vectors of one real order: row series * parts + part (cos, sin), one column a vector.
struct OrderNull {
  int order = 0;
  int parts = 2;
  Eigen::MatrixXd vectors;
};

/// Names the elementary components that null vectors touch. Wobble, and the reference's radial motion if both its
/// components are seen, are complex series with signed orders; everything else is real. The target's dx and both dz
/// are never read and always listed.
std::vector<NotSeparable> ListLostComponents(const std::vector<OrderNull>& nulls);

}  // namespace twinbench::separate
