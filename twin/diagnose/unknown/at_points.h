#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "twin/diagnose/engine/family.h"

/// Structure without a name that enters at a point of the twin, not on a channel.
namespace twinbench::diagnose::unknown {

/// A point and how the readings answer to it.
struct AtPoint {
  std::string name, unit;
  double to_SI = 1.0;
  double plausible = 0.0;  // SI of a disturbance nobody thought of
  Eigen::MatrixXd slope;   // readings x channels
};

/// A number of each reading.
struct Along {
  std::string name, unit;
  double to_SI = 1.0;
  Eigen::VectorXd value;  // SI
};

/// What the rows show of courses at a point: (reading i, channel c: i * channels + c) x courses.
Eigen::MatrixXd ShownOf(const Eigen::MatrixXd& slope, const Eigen::MatrixXd& courses);

/// One family a point: what goes by two coordinates together, where what goes by one alone is free; polynomials of
/// degrees 1 and 2 of each. The grid are the pairs.
std::vector<Family> Interactions(const std::vector<AtPoint>& points, const std::vector<Along>& coordinates);

/// A wave along a coordinate, of any period between two.
Family Fringes(const AtPoint& point, const Along& along, double shortest, double longest);

}  // namespace twinbench::diagnose::unknown
