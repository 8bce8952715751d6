#pragma once

#include <Eigen/Core>

#include "optics/height_map.h"
#include "twin/benches/freeform_five_axis/settings.h"
#include "twin/core/frames.h"
#include "twin/core/reading.h"

/// What the probe sees of the artefact, in closed form: a laser spot whose reflection a lens takes to a quadrant
/// detector, and whose height a camera beside it sees.
namespace twinbench::sim {

struct ArtefactCell {
  int i = 0, j = 0;
};

struct ProbeSpot {
  Vector3 hit_F = Vector3::Constant(kNaN);        // on the surface, from the cell's vertex
  Vector3 reflected_T = Vector3::Constant(kNaN);  // direction, in the tool's frame
  double distance_m = kNaN;                       // from the tip along the beam
};

/// @param X_FT  Tool in the artefact.
/// @param height_m  Of this cell above where it should be.
/// @param form  Heights over the whole array beside its form; null: none.
ProbeSpot Look(const ArtefactSettings& artefact, const ArtefactCell& cell, const Pose& X_FT, double height_m = 0.0,
               const optics::HeightMap* form = nullptr);

struct ProbeSignals {
  double qpd_x_V = kNaN, qpd_y_V = kNaN, qpd_sum_V = kNaN, ccd_px = kNaN;
};

/// Where the lens takes the reflection on the detector [m]; the detector stands in its focus, so that the place of
/// the beam does not matter.
Eigen::Vector2d OnQuadrants_m(const QuadrantSettings& qpd, const ProbeSpot& spot);

/// Voltages of a Gaussian spot there.
void ShowQuadrants(const QuadrantSettings& qpd, const Eigen::Vector2d& at_m, ProbeSignals& signals);

/// The height in the camera.
double Camera_px(const CameraSettings& ccd, double distance_m);

}  // namespace twinbench::sim
