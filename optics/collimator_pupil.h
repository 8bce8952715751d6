#pragma once

#include <Eigen/Core>
#include <vector>

/// How a collimator's round beam is divided into rays.
namespace twinbench::optics {

/// Points that share a disc in equal parts: rings of equal width, 4 (2 i - 1) points on the i-th, each ring at the
/// radius that halves its area.
///
/// @return 4 rings^2 positions [m].
/// @throws std::invalid_argument unless radius_m is positive and finite and rings from 1 to 1000.
///
/// All moments up to the third are exactly those of the disc; the fourth is off by the order of 1 / rings^2. The
/// weights are equal for the sake of hard edges across the beam: a rule of higher order would gain nothing there.
std::vector<Eigen::Vector2d> EqualAreaDisc(double radius_m, int rings);

/// How much of the piece around a point of EqualAreaDisc lies inside the disc when the point has come to the
/// distance `r_m` from the centre: one up to the outermost ring, then falling to nothing at Reach.
///
/// So a beam that comes back a little aside loses its light smoothly, to first order as much as a full disc does;
/// what it loses counts at the outermost ring instead of the edge, 1 / (2 rings) of the radius too far in.
double ShareInside(double radius_m, int rings, double r_m);
double Reach(double radius_m, int rings);

}  // namespace twinbench::optics
