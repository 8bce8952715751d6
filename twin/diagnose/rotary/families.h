#pragma once

#include <string>
#include <vector>

#include "twin/diagnose/engine/family.h"
#include "twin/diagnose/rotary/rotary_run.h"

/// Candidates for the rotary bench: every effect of the catalogue that leaves a linear trace, and generic shapes.
namespace twinbench::diagnose::rotary {

/// Time series on each of the channels, shared by the named and the generic families that combine them.
struct SharedSeries {
  std::shared_ptr<const Base> tone, step;
  std::vector<double> frequency_Hz;
  std::vector<int> onset;
};
SharedSeries MakeSharedSeries(const RotaryRun& rotary);

/// Families keep references to `rotary` and `context`, which must outlive them.
std::vector<Family> NamedFamilies(const RotaryRun& rotary, const SignalContext& context, const Scenario& scenario,
                                  const SharedSeries& series);
std::vector<Family> UnknownFamilies(const RotaryRun& rotary, const SignalContext& context,
                                    const SharedSeries& series);

/// With the published equations as the model: which of their sensitivities are off (yaw, tilt).
std::vector<Family> ModelFamilies(const RotaryRun& rotary);

/// The places "yaw", "tilt", "roll", "lateral" and the channels with their weights, each of largest weight 1.
struct Place {
  std::string name;
  Eigen::VectorXd weight;
};
std::vector<Place> PlacesOf(const Eigen::Matrix4d& shown_by_motion);

/// Map from k signals on each channel to k amplitudes of a weighted pattern: (channels k) x k.
Eigen::MatrixXd PatternMap(const Eigen::VectorXd& weight, int signals);

}  // namespace twinbench::diagnose::rotary
