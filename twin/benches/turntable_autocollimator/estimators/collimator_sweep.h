#pragma once

#include <optional>
#include <vector>

#include "twin/core/reading.h"

/// What a sweep through known angles says of the autocollimator itself.
namespace twinbench::separate::turntable {

struct SweptValue {
  double value = kNaN;
  double u = kNaN;  // standard uncertainty
};

/// A wave along the angle, as the pixels of a camera make it.
struct SweptRipple {
  SweptValue period_rad, amplitude_rad;
};

/// What one axis of the autocollimator shows of the reference.
struct SweptAxis {
  SweptValue scale;            // shown angle by the reference's, with its sense: slope of the line of least squares
  SweptValue scale_in_middle;  // of the curve, in the middle of the sweep; NaN: it does not bend
  SweptValue bend_rad;         // where the curve lies farthest from that line; NaN: it does not bend
  std::vector<SweptRipple> ripples;   // the largest first
  SweptValue reversal_rad;            // forward less backward; NaN: one way only
  double shortest_period_rad = kNaN;  // of a ripple that the steps of the reference can show
  double residual_rms_rad = kNaN;
  double u_reading_rad = kNaN;  // of one reading, from what the fit leaves
  double dof = 0.0;

  /// +1, -1, or 0 where it does not follow.
  int Sense() const;
};

struct CollimatorSweep {
  int readings = 0;
  double lowest_rad = kNaN, highest_rad = kNaN;  // of the reference
  bool is_along_y = false;                       // the reference tilts the mirror: y follows it
  SweptAxis axis;                                // that follows
  std::optional<SweptValue> crosstalk;           // what the other axis shows by what this one does
};

/// Readings of the phase calibration, the reference's angle that of the turntable: x, or y where that follows more,
/// by least squares as a constant a pass, a line, its square and cube, and waves. Of the latter each is taken if
/// chance leaves as much by it in one of a thousand sweeps only (F test, the wave's by all periods that were looked
/// at).
///
/// @return nothing of fewer than kFewestSwept readings, or where neither axis has any.
/// Uncertainty: scatter of the readings about the fit. Not included: that of the reference; ripple whose period the
/// steps do not show, or that looks like a longer one by them.
std::optional<CollimatorSweep> AnalyseSweep(const std::vector<Reading>& readings);

inline constexpr int kFewestSwept = 6;

}  // namespace twinbench::separate::turntable
