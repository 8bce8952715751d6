#pragma once

#include "optics/collimator_pupil.h"
#include "optics/kernels.h"

/// The arithmetic of an autocollimator's beam on its way back, all rays together.
namespace twinbench::optics {

/// Turns those rays back that met the front of surface `id`, on its +z side. The others go on as they were.
/// @param hits  First meetings of `outgoing`.
void ReflectFrom(const Frame& mirror, int id, const RayBatch& outgoing, const HitBatch& hits, RayBatch& returning);

/// An ideal thin lens and the camera behind it.
struct ImagingLens {
  double focal_length_m, defocus_m, distortion_per_rad2;
  PupilEdge edge;
};

/// Sums over the rays that came back through the lens.
struct CameraSums {
  double light = 0.0;            // in rays
  double x_m = 0.0, y_m = 0.0;  // light times place on the camera, x to the right as seen from behind it
};

/// @param objective  Surface of the lens; its frame looks at the mirror along z.
/// @param hits       First meetings of `returning`.
CameraSums SumOnCamera(const ImagingLens& lens, int objective, const RayBatch& returning, const HitBatch& hits);

}  // namespace twinbench::optics
