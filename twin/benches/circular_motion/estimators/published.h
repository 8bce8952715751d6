#pragma once

#include "twin/benches/circular_motion/estimators/circle_model.h"

/// The bar as its paper evaluates it. The paper's equations did not survive in print; numbers are those of the
/// text.
namespace twinbench::separate::circular {

/// Eqs 8 to 15: the centre (a, b) that leaves the least of DR - a cos th - b sin th, without a constant, th as the
/// encoder shows it; commanded where there is none.
/// @param points  Of one set-up of the bar.
Eigen::Vector2d PublishedOffset_m(const std::vector<CirclePoint>& points);

/// Eqs 1 to 4, 16 and 17: deviation from the commanded point, the offset taken out of the radius only.
Eigen::Vector2d PublishedDeviation_m(const CirclePoint& point, const Eigen::Vector2d& offset_m);

}  // namespace twinbench::separate::circular
