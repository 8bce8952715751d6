#pragma once

#include "optics/psd.h"

/// Four photodiodes about a gap.
namespace twinbench::optics {

/// Shares of a spot's light, times its power: + and - by the sign of u and v.
struct QuadrantPowers {
  double pp = 0.0, mp = 0.0, mm = 0.0, pm = 0.0;

  double Sum() const { return pp + mp + mm + pm; }
  double RightMinusLeft() const { return pp + pm - mp - mm; }
  double TopMinusBottom() const { return pp + mp - mm - pm; }
};

/// What the quadrants get of a Gaussian spot of any covariance; the outer edges are far away. A point counts as a
/// spot that is far smaller than the gap.
///
/// @param gap_m  Between the quadrants, full width.
/// Exact; a spot whose axes lie askew by an integral over its correlation (Drezner and Wesolowsky, J. Stat. Comput.
/// Simul. 35 (1990) 101-107), to 1e-12 of the light up to a correlation of 0.9.
QuadrantPowers OnQuadrants(const Spot& spot, double gap_m);

}  // namespace twinbench::optics
