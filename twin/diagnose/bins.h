#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

/// How curves are made of values at many places.
namespace twinbench::diagnose {

/// Places, and which of them each value belongs to. Few values: one place each; else the middles of equal parts.
struct Bins {
  std::vector<int> of_value;   // one a value; -1 where it is not known
  std::vector<double> centre;  // ascending
};

/// @param x            NaN: not known.
/// @param most_values  Different ones that have places of their own.
/// @param parts        Where there are more.
Bins MakeBins(const Eigen::VectorXd& x, std::size_t most_values, int parts);

/// In one turn, without -0 and 360 for the same place; to a millionth of a degree.
Eigen::VectorXd InTurn_deg(const Eigen::VectorXd& angle_deg);

}  // namespace twinbench::diagnose
