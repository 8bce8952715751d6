#pragma once

#include <optional>
#include <vector>

#include "twin/benches/rotary_4dof/estimators/geometry.h"
#include "twin/benches/rotary_4dof/estimators/motion.h"

/// Equations 1-12 of Jywe et al., Int. J. Mach. Tools Manuf. 47 (2007) 1978-1987, signs recovered from their
/// algebra.
///
/// The one place where the paper's frame meets ours. The paper's P_Ax grows with its yaw and its shift, P_Ay with
/// its tilts; on the exact model P_Ax falls with ez and dy of L, P_Ay falls with ey and grows with ex. So the
/// paper's frame is L turned by 180 degrees about x with the PSD axes kept: ex_p = ex, ey_p = -ey, ez_p = -ez, dy_p
/// = -dy (a test checks the four signs against the exact model).
///
/// The equations turn the diffracted orders by twice the angle, as a mirror would: ez is over-read by
/// (1 + sec)/(2 cos) = 1.133, ex under-read by (1 + cos)/2 = 0.960, dy under-read by cos = 0.921; ey is exact. The
/// rigorous estimator has none of this.
namespace twinbench::measure {

/// Motion in L from spot coordinates [a_u, a_v, b_u, b_v] in m, by eqs. 6, 8, 10 and 12. dy still contains the
/// constant Dy of the set-up; eq. 9 removes it over a full circle.
/// @return NaN where an arcsine has no value.
Vector4 PublishedMotion(const Vector4& spots_m, double l1_m, const BenchGeometry& geometry);

/// l1 from the yaw sweep of the calibration phase, eq. 7 as a least-squares slope with a free constant.
/// @return nothing without a sweep (less than three usable readings or no yaw in them).
std::optional<double> PublishedDistance(const std::vector<Reading>& readings, const BenchGeometry& geometry);

/// Eq. 9: takes the mean of dy away in each set-up of each phase.
void RemoveShiftConstants(std::vector<Motion>& motions);

}  // namespace twinbench::measure
