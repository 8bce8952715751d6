#pragma once

#include "twin/benches/rotary_4dof/estimators/geometry.h"
#include "twin/benches/rotary_4dof/estimators/motion.h"

namespace twinbench::diagnose::rotary {

/// Equations 1-12 of Jywe et al. (2007) as printed, solved for the spots [m]: the published forward model, which
/// knows no deviations of the light.
/// @param motion  Pose of the grating [ez, ex, ey (rad), dy (m)] at the nominal spot; the paper's x, z and normal
///                point against ours.
measure::Vector4 PublishedSpots_m(const measure::BenchGeometry& geometry, const measure::Vector4& motion);

/// d spots / d motion by central differences.
Eigen::Matrix4d PublishedSlopes(const measure::BenchGeometry& geometry, const measure::Vector4& motion);

}  // namespace twinbench::diagnose::rotary
