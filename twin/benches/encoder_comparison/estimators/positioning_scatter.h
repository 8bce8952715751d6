#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "twin/benches/encoder_comparison/estimators/iso230_2.h"

/// What the scatter of the runs does to any figure of an axis, whichever standard defines it.
namespace twinbench::measure {

/// All targets from one side, one entry a target; NaN where runs are too few.
struct Side {
  Eigen::ArrayXd runs, mean, deviation, rounding;

  Eigen::ArrayXd Low() const { return mean - 2.0 * deviation; }
  Eigen::ArrayXd High() const { return mean + 2.0 * deviation; }
};

/// Figures of an axis from its forward and its backward side.
using AxisFigures = std::function<Eigen::ArrayXd(const Side& forward, const Side& backward)>;

/// Every figure with the standard deviation and the bias that the scatter of the runs gives it, as EvaluatePositioning says.
/// @param stream  Name of the stream of random numbers.
std::vector<ScatteredValue> WithScatter(const std::vector<TargetPositioning>& targets, const AxisFigures& figures,
                                        const PositioningBootstrap& bootstrap, const std::string& stream);

}  // namespace twinbench::measure
