#pragma once

#include "twin/benches/turntable_autocollimator/diagnosis/turntable_run.h"
#include "twin/diagnose/diagnosis.h"
#include "twin/diagnose/engine/analysis.h"

namespace twinbench::diagnose::turntable {

/// Teeth that seat differently at every lift: x scatters more than stated, y does not.
struct Seating {
  double log_bayes = 0.0;  // against one factor of the noise that both axes share; 0: nothing speaks for it
  double scatter_rad = 0.0;
  double u_scatter_rad = kNaN;
  double smallest_rad = kNaN;  // that would have been seen
};

/// From what the causes of the analysis leave of the residuals, single far values left out. A wrong noise figure of
/// the autocollimator makes both axes louder and is no seating; nor is what neighbouring readings have in common.
Seating MeasureSeating(const TurntableRun& turntable, const Analysis& analysis);

/// Log Bayes factor from which seating is claimed: in white noise less than one run in four hundred.
inline constexpr double kSeated = 6.0;

Cause SeatingCause(const Seating& seating);
Detectable DetectableSeating(double smallest_rad);

/// The run with this scatter in its noise.
LinearRun WithScatter(const TurntableRun& turntable, double scatter_rad);

}  // namespace twinbench::diagnose::turntable
