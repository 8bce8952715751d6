#pragma once

#include <map>

#include "twin/benches/encoder_comparison/estimators/lap_scatter.h"
#include "twin/benches/encoder_comparison/estimators/mountings.h"
#include "twin/benches/encoder_comparison/estimators/scale_steps.h"

namespace twinbench::separate::encoder {

struct DeviceOptions {
  int max_order = 64;              // a turn; fewer where the angles read do not determine as many
  double max_inflation = 4.0;      // HighestOrder
  double max_noise_factor = 10.0;  // SeparateMountings
  int pooled_orders = 4;           // NoiseOf
  ScaleSteps steps = {};           // of the device
  std::vector<int> of_lines = {};  // orders of its lines, teeth and signals, as far as they are known
};

/// The groups that have turns, and the highest order that all of them determine. A group that allows less than half
/// the orders of the best one is not used: the others need not suffer for it.
struct UsableGroups {
  int highest = 0;
  std::vector<PassGroup> used, poor;
};
UsableGroups PickUsable(const std::vector<PassGroup>& groups, const DeviceOptions& options);

struct ComparisonFit {
  std::vector<FittedGroup> groups;  // they point to the groups handed in
  OrderNoise noise;
  Rounding rounding;
  Unresolved unresolved;
  std::map<int, double> mounting_rad;  // by set-up: device angle where the reference shows 0
  SeparatedCurves curves;
};

/// Fits every group and separates both errors. The device's angles need mounting and reference's error, which need
/// the fit: a few rounds, each of which takes what is wrong down by the slope of the curves.
ComparisonFit FitComparison(const UsableGroups& groups, const DeviceOptions& options);

}  // namespace twinbench::separate::encoder
