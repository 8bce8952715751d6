#pragma once

#include <map>
#include <string>
#include <vector>

#include "twin/benches/circular_motion/estimators/circle_path.h"
#include "twin/benches/circular_motion/estimators/iso230_4.h"
#include "twin/core/estimator.h"

namespace twinbench::benches::circular {

/// What either estimator makes of a run.
struct CircleAnalysis {
  std::vector<separate::circular::CirclePoint> points;
  separate::circular::CircleFit fit;  // published: nothing is fitted
  std::vector<separate::circular::CirclePath> paths;
  std::vector<separate::circular::Iso230_4> deviations;
  std::map<int, Eigen::Vector2d> published_offset_m;  // by set-up, of the bar

  bool IsFitted() const { return fit.shared.IsKnown(); }
};

/// @throws InputError if no reading has radius and angle, or they are too few for the unknowns.
CircleAnalysis Analyse(const Scenario& scenario, const std::vector<Reading>& readings, Estimator estimator);

/// An error of machine or instruments in the unit of its scenario key. u: NaN if the run does not show it.
struct ErrorValue {
  std::string key, unit;
  double value = kNaN, u = kNaN;
};
/// Waves as amplitude and azimuth, as the scenario has them.
std::vector<ErrorValue> ErrorsOf(const separate::circular::CircleFit& fit);

}  // namespace twinbench::benches::circular
