#pragma once

#include "twin/benches/encoder_comparison/estimators/curve_fit.h"

namespace twinbench::separate::encoder {

struct FittedGroup {
  const PassGroup* group = nullptr;
  ScaleAngles th_rad;
  CurveFit fit;
};

/// How much one reading scatters, order by order: the variance of white noise that would make the coefficients of
/// order k scatter as they do.
struct OrderNoise {
  Eigen::VectorXd variance_rad2;  // [k - 1]
  double white_rad2 = kNaN;       // mean over all orders: of a reading about its fit
  double dof = kNaN;              // behind the variance of an order; of the first, which has the fewest
  bool between_laps = false;      // false: no group has two full laps, and white noise is assumed
};

/// From the scatter of the coefficients between the laps (full turns) of each group, all groups together: what
/// changes from turn to turn, and drift that is no straight line, counts where it acts. Order k is pooled with
/// min(k - 1, `pooled_orders`) orders on either side.
OrderNoise NoiseOf(const std::vector<FittedGroup>& groups, int highest, int pooled_orders);

}  // namespace twinbench::separate::encoder
