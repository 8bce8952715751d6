#pragma once

#include <Eigen/Core>
#include <vector>

#include "twin/core/scenario.h"
#include "twin/diagnose/diagnose.h"

/// Readings so far from all around them that nothing else could be fitted beside them.
namespace twinbench::diagnose::encoder {

struct Glitches {
  std::vector<int> rows;     // in their order
  Eigen::VectorXd size_rad;  // of each: how far it is from the middle of its neighbours
};

/// One reading, or a few in a row, far outside of what the readings before and behind them scatter by, while these
/// agree with each other and the reference goes on as usual. Finds none where many readings lie half as far (then
/// the noise has heavy tails), where stops are read again and again (what settles looks so), or where the far ones
/// come back at one angle.
/// @param run  Its residual is looked at.
/// @param relative_noise  Of each reading, in that of the usual one: a mean of few samples may lie farther off.
Glitches FindGlitches(const LinearRun& run, const Eigen::VectorXd& relative_noise);

/// What the readings beside a glitch show is put in its place.
void Bridge(const Glitches& glitches, Eigen::VectorXd& rows);

/// As outliers, with their places; those that the search has found besides are counted with them. One
/// or two may as well be of a place that no other pass has read.
/// @param scenario  What it states is not doubted.
void TellGlitches(const Glitches& glitches, const Scenario& scenario, DiagnosisRun& result);

}  // namespace twinbench::diagnose::encoder
