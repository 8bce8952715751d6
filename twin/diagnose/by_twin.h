#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "twin/core/bench_format.h"
#include "twin/diagnose/diagnose.h"
#include "twin/model/follow.h"

/// A diagnosis put together from what every bench has anyway: its format, its catalogue and its twin that follows
/// the record. A bench that has more to say (motions that are free at every stop, causes with signatures of their
/// own) builds its run and its families itself.
namespace twinbench::diagnose {

/// What a bench says so that its readings are compared with its twin's. Channels are those of its format; unless
/// `shown` says otherwise they are read in the format's columns that a bench must show, in the same order.
struct TwinComparison {
  /// An angle that structure may be locked to, and where a reading keeps it.
  struct KnownAngle {
    std::string name;  // of the format's angles
    double Reading::*rad;
  };

  const BenchFormat* format = nullptr;  // never null
  model::FollowMaker follow;
  std::string unit;  // of values in reports: "um"
  double to_SI = 1.0;
  double noise = 0.0;  // stated standard uncertainty of one reading, SI; 0: taken from the readings
  std::vector<std::string> free_points;  // a constant of each set-up is free there
  std::vector<KnownAngle> angles;        // the first is the one that the bench goes through
  double plausible = 0.0;                // rms of a disturbance that nobody thought of, SI

  // Of a bench that shows other things in other set-ups, or channels of unlike noise: one value a channel, SI.
  std::function<Eigen::VectorXd(const Reading&)> shown = {};                      // NaN: not shown
  std::function<Eigen::VectorXd(const Scenario&, const Reading&)> noise_of = {};  // counts instead of `noise`
};

/// Readings against the twin's, with the free constants that fit best.
/// @throws InputError if fewer than 12 readings have every value that the bench must show, or the twin shows
/// nothing
///         where a reading has one.
LinearRun CompareWithTwin(const std::vector<Reading>& readings, const Scenario& scenario,
                          const TwinComparison& comparison);

/// @throws InputError as above, or if the design has no redundancy.
DiagnosisRun DiagnoseByTwin(const std::vector<Reading>& readings, const Scenario& scenario,
                            const DiagnoseOptions& options, const TwinComparison& comparison);

}  // namespace twinbench::diagnose
