#pragma once

#include "twin/benches/circular_motion/settings.h"
#include "twin/core/frames.h"

/// What bar, encoder and grid show of the spindle's position, without noise.
namespace twinbench::sim {

/// @param p_m      Of the spindle, from the commanded centre.
/// @param above_K  Temperature above that of reference.
double BarShown_m(const BarSettings& bar, const Eigen::Vector2d& p_m, double radius_m, double above_K);

/// In the turn about `commanded_rad`.
double EncoderShown_rad(const BarEncoderSettings& encoder, const BarSettings& bar, const Eigen::Vector2d& p_m,
                        double commanded_rad);

Eigen::Vector2d GridShown_m(const GridSettings& grid, const Eigen::Vector2d& p_m);

}  // namespace twinbench::sim
