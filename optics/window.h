#pragma once

#include <Eigen/Geometry>
#include <limits>
#include <utility>

#include "optics/surface.h"

/// The glass in front of a detector: two faces, plate shift, reflections, interference between the faces.
namespace twinbench::optics {

struct Window {
  double thickness_m = std::numeric_limits<double>::quiet_NaN();  // at the centre
  double index = std::numeric_limits<double>::quiet_NaN();
  double gap_m = std::numeric_limits<double>::quiet_NaN();        // back face -> silicon
  double reflectance = std::numeric_limits<double>::quiet_NaN();  // of one face, power
  double wedge_rad = 0.0;                                         // thickness grows along +u by this slope
  bool coherent = false;  // interference between the faces instead of an incoherent in-window ghost
};

/// Package (window, blackened rim) around the active area: light beyond it passes by.
inline constexpr double kPackageMargin_m = 4e-3;

/// Back and front face of the window of a detector at X_LP, normals towards the light.
std::pair<Surface, Surface> WindowFaces(const Window& window, const Eigen::Isometry3d& X_LP, double width_m,
                                        double height_m);

struct Refracted {
  Eigen::Vector3d direction;
  bool total_reflection = false;  // direction is then the reflected one
};

/// Snell's law; `index_ratio` is n(before) / n(after); the normal may have either sign.
Refracted Refract(const Eigen::Vector3d& d, const Eigen::Vector3d& normal, double index_ratio);

Eigen::Vector3d Reflect(const Eigen::Vector3d& d, const Eigen::Vector3d& normal);

/// What interference between the faces does to a Gaussian patch.
struct Etalon {
  double transmission = 1.0;                          // of the window with all internal reflections
  Eigen::Vector2d shift_m = Eigen::Vector2d::Zero();  // of the centroid
};

/// Airy transmission averaged over a Gaussian patch whose interference phase varies linearly across it.
///
/// @param phase_rad           4 pi n t cos(theta_inside) / lambda at the patch's centre.
/// @param phase_gradient_per_m  Its gradient along (u, v).
/// @param cov_m2              Covariance of the patch.
///
/// Closed form: the Airy function is a Fourier series in the phase, each term of which has a Gaussian average. Not
/// included: variation of the amplitude ratio with angle, walk-off between the interfering patches.
Etalon Interfere(double reflectance, double phase_rad, const Eigen::Vector2d& phase_gradient_per_m,
                 const Eigen::Matrix2d& cov_m2);

/// Phase and its gradient where a beam of direction d_P (frame P) crosses at position (u, v).
///
/// @param direction_slopes_per_m  Change of the direction's (u, v) components per displacement (u, v) in the patch:
///        the wavefront's curvature, as a 2 x 2 matrix.
std::pair<double, Eigen::Vector2d> EtalonPhase(const Window& window, double wavelength_m,
                                               const Eigen::Vector3d& d_P, double u_m,
                                               const Eigen::Matrix2d& direction_slopes_per_m);

/// @throws std::invalid_argument naming the field that is missing or out of range.
void Validate(const Window& window);

}  // namespace twinbench::optics
