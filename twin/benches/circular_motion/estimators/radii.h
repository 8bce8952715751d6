#pragma once

#include <vector>

#include "twin/benches/circular_motion/estimators/circle_path.h"

namespace twinbench::separate::circular {

/// Radii about the commanded centre, less the nominal one, of one or two paths; and what they lean on.
struct Radii {
  Eigen::VectorXd deviation_m, u_own_m, of_machine, of_steps, angle_rad;  // of_: shares of the square of u_own_m
  Eigen::MatrixXd slope;       // rows x unknowns
  Eigen::VectorXd stands_for;  // in the least-squares circle: as many readings; 1 each where they are even
  std::vector<Eigen::Index> rounded_with;  // first of the readings in a row that show the same value: their rounding errors are one

  bool IsUneven() const { return (stands_for.array() != 1.0).any(); }
  Eigen::Index Count() const { return deviation_m.size(); }
  PartedVariance Own(Eigen::Index i) const {
    const double all = u_own_m[i] * u_own_m[i];
    return {all, of_steps[i] * all, of_machine[i] * all};
  }
};

Radii RadiiOf(const std::vector<const CirclePath*>& paths);

/// From 0 to a turn.
double WithinTurn_rad(double angle_rad);

/// What centre and radius of a circle make of each; where readings are uneven, behind them what the lobes of orders 2 and 3 do, which would
/// go into the centre.
Eigen::MatrixXd CircleOf(const Radii& radii);

/// The radii about their least-squares centre, and so what they lean on.
Radii AboutOwnCentre(Radii radii);

}  // namespace twinbench::separate::circular
