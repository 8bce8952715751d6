#pragma once

#include <functional>
#include <string>
#include <vector>

#include "twin/diagnose/by_twin.h"
#include "twin/diagnose/engine/followed.h"
#include "twin/diagnose/engine/free_constants.h"
#include "twin/diagnose/engine/wave_series.h"
#include "twin/diagnose/grouping.h"
#include "twin/diagnose/single_outliers.h"

/// A record beside its twin: the first half of a diagnosis by the twin.
namespace twinbench::diagnose {

/// What the readings showed, what the twin says with the constants that fit best, and those constants.
struct Compared {
  std::vector<Reading> used;
  Followed twin;
  LinearRun run;
  FreeConstants free;
  Eigen::VectorXd predicted = {};  // with those constants, by reading and channel, without noise that was read
  Schedule readings = {};          // those of the run are of groups of readings
  Grouping groups = {};
  SingleOutliers outliers = {};  // that were left out

  /// What is shown of readings (x channels) as rows of the run.
  Eigen::VectorXd Rows(const Eigen::MatrixXd& by_reading) const { return ByRow(groups.Mean(by_reading)); }
  /// From readings to rows of one channel; empty: they are the same.
  ToRows Means() const;
};

/// @throws InputError as CompareWithTwin does.
Compared Compare(const std::vector<Reading>& readings, const Scenario& scenario, const TwinComparison& comparison);

/// How the channels answer to a point: by a pattern [SI per SI], of which every reading shows a share. It is one but
/// where the twin knows better: of what another instrument sees and the bench follows, nothing is shown.
struct Response {
  Eigen::VectorXd pattern;  // one a channel
  Eigen::VectorXd share;    // one a used reading
};
Response ResponseTo(const Compared& compared, const std::string& point);

/// One value a reading.
Eigen::VectorXd OfReadings(const std::vector<Reading>& readings,
                           const std::function<double(const Reading&)>& value);

/// SI of the point for one noise on the channel that shows it best, as it mostly is; NaN: there is no such point.
double PerNoise(const Compared& compared, const std::string& point);

}  // namespace twinbench::diagnose
