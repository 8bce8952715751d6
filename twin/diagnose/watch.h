#pragma once

#include <string>
#include <vector>

#include "twin/core/reading.h"
#include "twin/diagnose/engine/linear_run.h"

/// Watching a bench while it measures: every reading against what the readings before it predict.
namespace twinbench::diagnose {

struct WatchOptions {
  double false_alarm_rate = 0.01;  // a run: probability of any alarm though nothing is wrong
  int planned_readings = 0;        // of the whole run; 0: those that the run has
};

/// A reading from which on, or at which, the bench is not what the readings before say.
struct Alarm {
  int reading = 0;       // running number of the reading that raised it
  int since = 0;         // where the deviation seems to begin; the same reading for a single outlier
  std::string series;    // channel or pattern
  bool lasting = false;  // several readings say so; else this one, and it is not known whether others will follow
  double size = kNaN;    // in SI of the readings, of a pattern on the channel where it shows most
  double u_size = kNaN;
  double z = kNaN;      // chart statistic ...
  double limit = kNaN;  // ... and the limit that it passed
};

/// A reading against what those before it predict.
struct PredictedReading {
  int reading = 0;            // running number
  Eigen::VectorXd deviation;  // a channel: reading - prediction, SI; NaN where those before do not determine it
  Eigen::VectorXd u;          // of the deviation, by the stated noise
};

struct WatchReport {
  std::vector<PredictedReading> predicted;  // every reading of the run, in its order
  std::vector<Alarm> alarms;  // in the order in which they came
  int judged = 0;             // readings that those before them determine
  double limit_u = kNaN;      // of a single reading's deviation, in its u, as the noise is seen now
  double noise_scale = 1.0;   // readings' scatter about their predictions / what is stated
};

/// Limits of the charts that keep the false-alarm rate.
struct WatchLimits {
  double single = kNaN;   // of |z| of one reading
  double lasting = kNaN;  // of the cumulative sums
};

/// Half of the rate goes to single readings (Bonferroni over readings and series), half to two-sided cumulative
/// sums with reference value 0.5 over their mean run length (Siegmund, Sequential Analysis (1985), 10.2).
WatchLimits LimitsFor(double false_alarm_rate, int readings, int series);

/// Goes through the readings in their order. Each is predicted from all before it (free unknowns with their priors,
/// SequentialFit); what deviates goes to two charts a channel and a pattern. Readings whose channel is not yet
/// determined by those before are not judged: those of the first pass, and the first after a new mounting.
///
/// A reading beyond the limit of single readings is not learnt from. One event, one alarm: the series that raised
/// it and all that share a channel with it stay silent, after a single reading until three agree with their
/// predictions again, after a lasting deviation for good. The noise is rescaled by what was seen before (30 rows
/// weigh as much as the stated figure).
///
/// Not included: tails of the noise; with Student tails single readings alarm more often than stated.
WatchReport Watch(const LinearRun& run, const WatchOptions& options = {});

}  // namespace twinbench::diagnose
