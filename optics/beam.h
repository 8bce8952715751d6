#pragma once

#include <limits>
#include <vector>

#include "optics/irradiance.h"
#include "optics/ray.h"

/// The laser's beam as a few weighted rays that reproduce its moments: no random numbers, no noise of their own.
namespace twinbench::optics {

enum class BeamKind { kChiefRay, kGaussian, kProfile };

/// One ray relative to the chief ray: position across the beam [m] and slopes, with its share of the power.
struct BeamNode {
  double x_m = 0.0;
  double y_m = 0.0;
  double slope_x = 0.0;
  double slope_y = 0.0;
  double weight = 1.0;
};

using BeamNodes = std::vector<BeamNode>;  // weights sum to one

/// Nodes and weights for the average over a standard normal variable; exact for polynomials up to degree 2n - 1.
///
/// Golub and Welsch, Math. Comp. 23 (1969) 221-230: eigenvalues of the Jacobi matrix of the Hermite polynomials.
struct Quadrature {
  std::vector<double> node;
  std::vector<double> weight;
};
Quadrature GaussHermite(int n);

/// Gaussian beam of 1/e^2 radius w at the waist (= laser exit) and 1/e^2 half divergence: position and slope are
/// independent normals of deviation w/2 and divergence/2 (Wigner function of a Gaussian beam), n^4 rays.
BeamNodes GaussianBundle(double radius_m, double divergence_rad, int n);

/// The same beam as many rays of equal weight (m x m positions, each with 4 slopes): for hard edges, where a
/// polynomial rule fails. Moments to about 1/m.
BeamNodes DenseBundle(double radius_m, double divergence_rad, int m);

/// A measured beam: the map's pixels, gathered into at most `max_positions` blocks about their own centroids, each
/// with 4 slopes. The map's x is the beam's x; positions are relative to the map's origin.
/// @throws std::invalid_argument if the map holds no light.
BeamNodes ProfileBundle(const IrradianceMap& map, double divergence_rad, int max_positions);

/// What one of these blocks measures across the beam, x and y [m].
Eigen::Vector2d ProfileBlock_m(const IrradianceMap& map, int max_positions);

/// Axes across a beam: x horizontal (across z_L), y upwards.
struct BeamAxes {
  Eigen::Vector3d x;
  Eigen::Vector3d y;
};
BeamAxes AxesAcross(const Eigen::Vector3d& direction);

Ray NodeRay(const Ray& chief, const BeamAxes& axes, const BeamNode& node);

}  // namespace twinbench::optics
