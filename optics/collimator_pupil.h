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

/// How much of the piece around a point of EqualAreaDisc lies inside the disc when the point has come to another
/// distance from the centre: one up to the outermost ring, then falling to nothing at Reach.
///
/// So a beam that comes back a little aside loses its light smoothly, to first order as much as a full disc does;
/// what it loses counts at the outermost ring instead of the edge, 1 / (2 rings) of the radius too far in.
struct PupilEdge {
  double outermost_m, width_m;  // radius of the outermost ring, and of the piece around it
  double per_m;                 // one over the disc's radius

  [[gnu::always_inline]] inline double ShareInside(double r_m) const {
    const double beyond_m = r_m - outermost_m, outside_m = beyond_m < 0.0 ? 0.0 : beyond_m;
    const double depth = per_m * (outside_m < width_m ? outside_m : width_m), whole = per_m * width_m;
    return 1.0 - depth * (2.0 - depth) / (whole * (2.0 - whole));
  }
};
PupilEdge EdgeOfDisc(double radius_m, int rings);
double Reach(double radius_m, int rings);

}  // namespace twinbench::optics
