#pragma once

#include <string>
#include <vector>

#include "twin/benches/encoder_comparison/estimators/head_readings.h"
#include "twin/benches/encoder_comparison/estimators/scale_steps.h"
#include "twin/separate/series.h"

/// A ring calibrated by its own heads.
namespace twinbench::separate::encoder {

struct HeadOptions {
  int max_order = 64;              // fewer where the stops do not determine as many
  double max_noise_factor = 10.0;  // an order that would be noisier than so many times the best heads' is lost
  ScaleSteps steps = {};           // of the ring as every head shows it
};

/// Orders that no difference of these heads shows are not guessed; what they may be is said, as an assumption.
struct LostOrders {
  std::vector<int> orders;
  /// Root mean square of all of them in the curve, if the size of an order falls as 1 / order beside its neighbours.
  double assumed_rad = 0.0;
};

struct SeveralHeads {
  std::string not_separated;           // why there is no curve; the rest is then empty
  harmonics::HarmonicSeries ring;      // lost orders are NaN
  harmonics::HarmonicSeries ring_by_noise;  // the same without what published equations are known to be wrong by in its uncertainty
  harmonics::HarmonicSeries reference;  // what it shows too much, by its own angle; likewise; empty: too few stops
  LostOrders lost;
  std::vector<double> heads_rad;
  int stops = 0, left_out = 0;
  double rounding_share = 0.0;      // of the variance of the curve, what steps make that repeats
  double residual_rms_rad = kNaN;   // of one head's reading about the fit
  double reference_rms_rad = kNaN;  // of one instant of the reference beside its curve, noise of the heads apart
  double dof = kNaN;
  std::vector<std::string> notes;

  int Highest() const { return ring.Highest(); }
};

/// |mean over the heads of exp(-j order b)|^2: 0 for heads that tell an order as well as any, 1 where they all see
/// the same of it.
double Likeness(const std::vector<double>& heads_rad, int order);

/// All orders of the ring and of the reference by least squares over the readings of all heads, the angle of the
/// shaft free at each instant. The heads may stand anywhere and fail now and then.
///
/// Uncertainty: white noise of the heads, from the residuals, steps that round every visit of a place alike, and
/// orders above the highest (Unresolved). Not included: what all heads have in common at each place of the ring
/// (lost orders), motion of the shaft across its axis. Reference: docs/theory.md 12.1. For even stops the variance
/// is formula (V) of section 2 there with the heads for shifts.
SeveralHeads SeparateHeads(const std::vector<Reading>& readings, const HeadOptions& options = {});

/// As published for N heads at equal division, the first being the one that is calibrated: its reading less the mean
/// of all is the ring's error without the orders N, 2 N, ... (self-calibration), the mean itself an angle without all
/// other orders (equal-division averaging).
///
/// Instants at which a head failed are left out. Where the heads are not at equal division the difference is still
/// taken for the ring's error, as the equations say: the distance to the least-squares result, where it is above
/// twice the noise, is then part of the uncertainty.
/// Reference: Masuda, Kajitani, Precision Engineering 11 (1989) 95-100; Watanabe et al., Synthesiology 1 (2009)
/// 273-283 (SelfA).
SeveralHeads EqualDivision(const std::vector<Reading>& readings, const HeadOptions& options = {});

}  // namespace twinbench::separate::encoder
