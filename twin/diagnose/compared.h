#pragma once

#include <string>
#include <vector>

#include "twin/diagnose/by_twin.h"
#include "twin/diagnose/engine/followed.h"
#include "twin/diagnose/engine/free_constants.h"

/// A record beside its twin: the first half of a diagnosis by the twin.
namespace twinbench::diagnose {

/// What the readings showed, what the twin says with the constants that fit best, and those constants.
struct Compared {
  std::vector<Reading> used;
  Followed twin;
  LinearRun run;
  FreeConstants free;
  Eigen::VectorXd predicted = {};  // with those constants, by row
};

/// @throws InputError as CompareWithTwin does.
Compared Compare(const std::vector<Reading>& readings, const Scenario& scenario, const TwinComparison& comparison);

/// The used readings as the twin says them, with the format's columns.
std::vector<Reading> AsPredicted(const Compared& compared, const TwinComparison& comparison);

/// SI of the point for one noise on the channel that shows it best, as it mostly is; NaN: there is no such point.
double PerNoise(const Compared& compared, const std::string& point);

}  // namespace twinbench::diagnose
