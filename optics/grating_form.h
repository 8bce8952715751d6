#pragma once

#include <Eigen/Core>
#include <optional>

#include "optics/height_map.h"

namespace twinbench::optics {

/// A grating as it was made: a front that is not flat and grooves that do not lie where they should. In G, from its
/// middle: x across the grooves, z along them.
///
///     height  h = sphere (x^2 + z^2) / a^2 + astigmatism (x^2 - z^2) / a^2 + flatness map
///     grooves lie aside by  s = chirp x^2 / 2 + fan x z + ruling map, towards +x
///
/// So the grooves' distance grows by ds/dx and they turn by ds/dz. What moves a spot are the slopes of both;
/// heights of fractions of a micrometre themselves, which move it as far at most, are left out.
struct GratingForm {
  double half_width_m = 0.0;  // a
  double sphere_m = 0.0;
  double astigmatism_m = 0.0;
  double chirp_per_m = 0.0;
  double fan_rad_m = 0.0;
  std::optional<HeightMap> flatness_um;
  std::optional<HeightMap> ruling_um;

  bool IsPlain() const;
  Eigen::Vector2d HeightSlope(double x_m, double z_m) const;  // dh/dx, dh/dz
  Eigen::Vector2d GrooveSlope(double x_m, double z_m) const;  // ds/dx, ds/dz
};

/// What light meets at one place: the front's unit normal, and the vector across the grooves in the front, as long
/// as the grooves are dense there (1: as stated).
struct LocalGrating {
  Eigen::Vector3d normal, across;
};

/// To first order in the slopes.
/// @param across, normal, along  Unit axes x, y, z of G, and the result's frame.
LocalGrating LocalGratingAt(const GratingForm& form, const Eigen::Vector3d& across, const Eigen::Vector3d& normal,
                            const Eigen::Vector3d& along, double x_m, double z_m);

}  // namespace twinbench::optics
