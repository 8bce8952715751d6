#pragma once

#include "twin/benches/turntable_autocollimator/estimators/polygon_closure.h"

namespace twinbench::separate::turntable {

/// Circle closure by means: the constant of a clamping is the mean of its faces, the error of a face the mean of
/// what is left of it over the clampings, and the rest is summed with each order's waves (2 / N times), as if all
/// waves were orthogonal.
///
/// That is least squares where whole circles of faces are read in clampings evenly round the circle, and orders
/// stay below their number. Else waves do not average out over the clampings and enter the faces, and each other;
/// what that makes is not known here (`ClosureBias`).
/// @return `hidden` is not filled: the formula gives numbers for every order.
/// @throws InputError if there is no reading.
/// Reference: Estler, J. Res. NIST 103 (1998) 141 (dual closure); the formulas of Kinnane et al. (2015) are not
/// known to us beyond the abstract.
PolygonClosure ClosePolygonByMeans(const std::vector<FaceReading>& readings, int faces, int highest_order);

/// What an estimate differs from the rigorous one of the same readings, root mean square over the entries.
double ClosureBias_rad(const AngleSeries& estimate, const AngleSeries& rigorous);

}  // namespace twinbench::separate::turntable
