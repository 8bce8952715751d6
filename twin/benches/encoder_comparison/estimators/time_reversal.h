#pragma once

#include <string>
#include <vector>

#include "twin/core/reading.h"
#include "twin/separate/series.h"

/// A ring calibrated against the time while its spindle runs down.
namespace twinbench::separate::encoder {

struct CoastOptions {
  int max_order = 500;     // below half the lines of a turn
  int course_degree = 6;   // of the polynomial that the shaft's angle is of the time
  int pooled_orders = 8;   // on either side, whose scatter between turns is one order's
};

struct TimeReversal {
  std::string not_separated;  // why there is no curve; the rest is then empty
  harmonics::HarmonicSeries ring;
  harmonics::HarmonicSeries ring_by_noise;  // the same without what published equations are known to be wrong by in its uncertainty
  /// What acts on the spindle and repeats with its angle, as the angle by which it stands beside its smooth course at
  /// `reference_speed_rad_s`; at other speeds as the inverse square. Empty: not told from the ring.
  harmonics::HarmonicSeries torque;    // the same in both directions
  harmonics::HarmonicSeries friction;  // with the sense of rotation
  double reference_speed_rad_s = kNaN;  // the highest
  int lines = 0, turns = 0, passes = 0, left_out = 0;
  double stamp_noise_s = kNaN;  // of one time, from the scatter between turns
  double dof = kNaN;            // behind the variance of an order
  std::vector<std::string> not_separable, notes;
};

/// Every order by least squares over all turns of all passes: what is the ring's is the same in all of them, what a
/// torque does goes as the inverse square of the speed, what friction does changes its sign with the sense of
/// rotation. Each pass has a smooth course of its own.
///
/// Uncertainty: scatter of neighbouring orders between turns, which must be independent. Not included: motion of the
/// shaft across its axis under the one head, torques that change from pass to pass, orders from half the lines on.
/// Reference: docs/theory.md 12.2. The method is that of Lu et al., CIRP Annals 59 (2010) 529-534.
TimeReversal SeparateByTime(const std::vector<Reading>& readings, const CoastOptions& options = {});

/// Time-measurement dynamic reversal as its authors' abstract and patent (US 7840372) describe it: the loss of speed
/// in each turn from circular closure with the next one, mean over the turns of each speed and sense, mean of both
/// senses, two speeds extrapolated to where no torque counts. Their equations are not public in full; these are ours.
///
/// The distance to the least-squares result, where it is above twice the noise, is part of the uncertainty.
TimeReversal DynamicReversal(const std::vector<Reading>& readings, const CoastOptions& options = {});

}  // namespace twinbench::separate::encoder
