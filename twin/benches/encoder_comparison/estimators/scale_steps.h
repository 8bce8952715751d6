#pragma once

#include <Eigen/Core>
#include <cmath>
#include <utility>
#include <vector>

#include "twin/benches/encoder_comparison/estimators/lap_scatter.h"
#include "twin/benches/encoder_comparison/estimators/unresolved.h"

/// Steps of the device: what they round alike in every visit of a place is in no scatter, and no mean makes it less.
namespace twinbench::separate::encoder {

/// Of the variance that rounding repeats, what is counted besides as independent from place to place.
inline constexpr double kSmearedPart = 0.5;

/// Whether an order is no rounding: above half a step, or out of what steps and noise would make of it.
inline bool IsOwnOrder(double size_rad, double step_rad, double by_chance_rad2) {
  constexpr double kStandsOut2 = 16.0;
  return size_rad > 0.5 * step_rad || size_rad * size_rad > kStandsOut2 * by_chance_rad2;
}

struct ScaleSteps {
  double step_rad = 0.0;  // of one reading; 0: none
  double at_once = 1.0;   // readings whose mean one reading is
};

/// With the step that the readings have in common, where that is larger than the one that is stated.
ScaleSteps WithOwnStep(ScaleSteps stated, const std::vector<Reading>& readings);

/// Scatter of the visits of one place, and how many readings share a place; places less than half a step apart are one.
struct Visits {
  double squares_rad2 = 0.0, dof = 0.0, readings = 0.0, places = 0.0;

  /// @param at  Place in the turn, and what a fit leaves there; of one series of readings.
  void Add(std::vector<std::pair<double, double>> at, double step_rad);
  double Scatter_rad() const { return std::sqrt(squares_rad2 / dof); }
  double OfEach() const { return readings / places; }
};

/// What repeats in the fit of one group.
struct GroupRounding {
  std::vector<Eigen::MatrixXd> waves;    // [k - 1]: (re, im) of C_k by each wave of the saw-tooth
  std::vector<Eigen::Matrix2d> smeared;  // [k - 1]: covariance of (re, im) by what is independent from place to place
  double mean_rad2 = 0.0;                // variance of the mean over the places
};

struct Rounding {
  std::vector<GroupRounding> groups;  // one for each fitted group; without waves where there are no steps
  std::vector<int> direction;         // of each
  Eigen::MatrixXd same_places;        // 1: two groups were read at the same places of the device; 0: not
  double place_rad2 = 0.0;            // variance at one place, in the mean of all its visits
  double visits = 1.0;                // of a place, in one group

  std::vector<GroupRounding> folded;  // likewise, what orders above the highest add to those fitted; empty: nothing

  bool None() const { return groups.empty() || groups.front().waves.empty(); }
  void AddFolded(const std::vector<FittedGroup>& fitted, const Unresolved& unresolved);
  /// Covariance of (re, im) of order k between two groups. A place of the device is rounded alike in every mounting. In
  /// both directions half of it counts as common: a backlash of some steps makes it none, no backlash all, and which of
  /// the two it is rounded readings do not tell.
  Eigen::Matrix2d StepsBetween(std::size_t a, std::size_t b, int order) const;
  Eigen::Matrix2d FoldedBetween(std::size_t a, std::size_t b, int order) const;
  Eigen::Matrix2d Between(std::size_t a, std::size_t b, int order) const {
    return StepsBetween(a, b, order) + FoldedBetween(a, b, order);
  }
};

/// Noise before rounding is what visits of one place scatter by (NoiseBehindRounding); readings less than half a step
/// apart are visits of one place. Places are rounded as the fitted angles say: where stops and steps have a beat, all
/// of it is in a few orders. Orders of the device itself that are hidden there spread it: a part of it (kSmearedPart) is counted
/// once more, as independent from place to place.
Rounding RoundingIn(const std::vector<FittedGroup>& groups, const OrderNoise& noise, int highest, const ScaleSteps& steps);

}  // namespace twinbench::separate::encoder
