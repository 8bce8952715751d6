#pragma once

#include <map>
#include <string>
#include <vector>

#include "twin/benches/circular_motion/estimators/circle_path.h"
#include "twin/benches/circular_motion/estimators/iso230_4.h"
#include "twin/core/estimator.h"

namespace twinbench::benches::circular {

/// What the published equations do to the path of one pass beyond noise: against the rigorous fit of the same
/// readings.
struct PathBias {
  int setup = 0, pass = 0;
  double radial_m = kNaN, tangential_m = kNaN;  // rms
  double u_radial_m = kNaN, u_tangential_m = kNaN;  // noise of a reading, rms
  bool IsBiased() const { return radial_m > 2.0 * u_radial_m || tangential_m > 2.0 * u_tangential_m; }
};

/// What either estimator makes of a run.
struct CircleAnalysis {
  std::vector<separate::circular::CirclePoint> points;
  separate::circular::CircleConstants known = {};
  separate::circular::CircleFit fit;  // published: nothing is fitted
  std::vector<separate::circular::CirclePath> paths;
  std::vector<separate::circular::Iso230_4> deviations;
  std::map<int, Eigen::Vector2d> published_offset_m;  // by set-up, of the bar
  std::vector<PathBias> method_bias;  // published: part of the uncertainty of paths and deviations, which have none
                                      // where the readings are too few for the rigorous fit

  std::string lag_kind = {};          // of drives that lag: first_order | fixed_delay | ambiguous

  bool IsFitted() const { return fit.shared.IsKnown(); }
};

/// @throws InputError if no reading has radius and angle, or they are too few for the unknowns.
CircleAnalysis Analyse(const Scenario& scenario, const std::vector<Reading>& readings, Estimator estimator);

/// An error of machine or instruments in the unit of its scenario key. u: NaN if the run does not show it.
struct ErrorValue {
  std::string key, unit;
  double value = kNaN, u = kNaN;
  /// Shares of u^2: noise and quanta of the instruments, and what does not repeat: the machine's stated noise, and
  /// whatever is left over beyond all that is stated.
  double noise = kNaN, quantisation = kNaN, repeatability = kNaN;
  Eigen::VectorXd slope = {};  // by the unknowns of the fit, in its unit
};
/// Waves as amplitude and azimuth, as the scenario has them.
std::vector<ErrorValue> ErrorsOf(const separate::circular::CircleFit& fit);

/// What was fitted, but for these keys of ErrorsOf.
separate::circular::CircleErrors ErrorsWithout(const separate::circular::CircleFit& fit, const std::vector<std::string>& keys);

/// What errors of one kind, those of both axes together, make of the radial deviation that the instruments show. Together, because what lags
/// on both axes alike is hardly seen on a circle, however much it is.
struct RadialPart {
  std::vector<std::string> keys;  // of ErrorsOf
  double rms_m = kNaN;            // over all readings
};
/// One kind each, the largest first.
std::vector<RadialPart> RadialPartsOf(const CircleAnalysis& a);

/// Cosine or sine part of a wave. Unlike its amplitude, which is never below zero, a part is as likely too small as
/// too large however small the wave is: it is what an interval of +- U is right for.
struct WavePart {
  ErrorValue part;
  std::string amplitude, azimuth;  // keys of the scenario
  double order = 1.0, sign = 1.0;
  bool wave_of_sine = false, is_cosine = true;

  /// What the part is of a wave of this amplitude (in the unit of the part) and azimuth.
  double Of(double amplitude, double azimuth_deg) const;
};
/// Of those waves of which the run shows both parts.
std::vector<WavePart> WavePartsOf(const separate::circular::CircleFit& fit);

}  // namespace twinbench::benches::circular
