#pragma once

#include <string>
#include <utility>
#include <vector>

#include "twin/benches/circular_motion/estimators/circle_path.h"

/// Circular deviations as ISO 230-4:2022 has them (H: as the edition of 1996).
namespace twinbench::separate::circular {

struct Iso230_4Value {
  double value_m = kNaN, u_m = kNaN;  // u: NaN without one
  /// Shares of u^2, of which the rest is noise of the instruments: see PartedVariance; and what published equations are wrong by.
  double quantisation = 0.0, repeatability = 0.0, model = 0.0;
};

/// Of one set-up and feed; NaN where a direction is missing.
struct Iso230_4 {
  int setup = 0;
  double feed_m_s = 0.0;
  Iso230_4Value G_ccw, G_cw, G_b;           // circular deviation: range of the radius from the least-squares centre
  Iso230_4Value G_mz_ccw, G_mz_cw, G_mz_b;  // from the centre that makes it smallest: the minimum zone
  Iso230_4Value Fmax_ccw, Fmin_ccw;         // radial deviation from the least-squares centre: radius less the commanded one
  Iso230_4Value Fmax_cw, Fmin_cw, Fmax_b, Fmin_b;
  Iso230_4Value D;  // mean radial deviation of both paths: of their least-squares circle
  Iso230_4Value H;  // largest difference between the directions at one angle, linearly between the readings
};

/// Its values by their names: "G_ccw", "Fmax_b", ...
std::vector<std::pair<std::string, Iso230_4Value>> NamedValues(const Iso230_4& deviations);

/// One entry a set-up and feed, in the order of the paths.
///
/// Uncertainty: of the radius at the readings that are the extremes, by the noise that the readings show, and what noise makes extremes larger
/// by. The values are those of the readings as they are.
/// @param shared  Unknowns behind the paths; empty: no uncertainty is stated.
std::vector<Iso230_4> CircularDeviations(const std::vector<CirclePath>& paths, const SharedUncertainty& shared);

/// G of all paths about one centre, G(b) where they have both directions: nothing else is worked out. NaN without readings.
double CircularDeviation_m(const std::vector<CirclePath>& paths);

}  // namespace twinbench::separate::circular
