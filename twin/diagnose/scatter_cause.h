#pragma once

#include <Eigen/Core>

#include "twin/diagnose/by_twin.h"
#include "twin/diagnose/engine/analysis.h"

/// A cause that is no signature: what is drawn anew at each reading scatters more than stated.
namespace twinbench::diagnose {

/// At a point, SI.
struct Scattering {
  double log_bayes = 0.0;  // against one factor of the noise that all rows share; 0: nothing speaks for it
  double sd = 0.0;         // beyond what is stated
  double u_sd = kNaN;
  double smallest = kNaN;  // that would have been seen

  /// In white noise less than one run in four hundred.
  bool IsThere() const { return log_bayes > 6.0; }
};

/// Rows that show the point scatter more than stated, the others do not: a wrong noise figure makes all of them
/// louder. From what the causes of the analysis leave, single far values left out; what neighbouring readings have
/// in common is no scatter.
/// @param slope  d row / d point.
Scattering MeasureScatter(const LinearRun& run, const Analysis& analysis, const Eigen::VectorXd& slope);

Cause CauseOf(const Scattering& scattering, const TwinComparison& comparison);
Detectable DetectableOf(const Scattering& scattering, const TwinComparison& comparison);

}  // namespace twinbench::diagnose
