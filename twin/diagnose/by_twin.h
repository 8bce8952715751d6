#pragma once

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

/// What a bench says so that its readings are compared with its twin's. Channels are those of its format, read in
/// the format's columns that a bench must show, in the same order.
struct TwinComparison {
  /// An angle that structure may be locked to, and where a reading keeps it.
  struct KnownAngle {
    std::string name;  // of the format's angles
    std::function<double(const Reading&)> rad;
  };

  /// A point whose value at each reading is a sum of stated courses times constants that all set-ups share: an
  /// error that is a polynomial of its axis.
  struct FreeCourses {
    std::string point;
    std::function<Eigen::MatrixXd(const std::vector<Reading>&)> courses;  // readings x constants, dimensionless
  };

  /// An effect of the catalogue as a point times courses that depend on one shape, where asking the twin anew at
  /// every value of the shape would take too long: a wave whose period is not known.
  struct Product {
    std::string effect, where, point;
    std::vector<std::string> sizes;  // parameters in the unit of the point, one a course
    std::string shape;               // the parameter that courses depend on
    std::function<std::vector<double>(const std::vector<Reading>&)> values;                  // SI, to be tried
    std::function<Eigen::MatrixXd(const std::vector<Reading>&, double shape)> courses = {};  // readings x sizes
  };

  const BenchFormat* format = nullptr;  // never null
  model::FollowMaker follow;
  std::string unit;  // of values in reports: "um"
  double to_SI = 1.0;
  double noise = 0.0;  // stated standard uncertainty of one reading, SI; 0: taken from the readings
  std::vector<double> noise_of_channel = {};  // instead, where channels read different things
  std::vector<std::string> free_points;       // a constant of each set-up is free there
  std::vector<FreeCourses> free_courses = {};
  int free_rounds = 2;       // of their fit, each with slopes about what the last one found
  double free_rank = 1e-10;  // directions of the free constants that show less, of the most, are not fitted
  std::vector<Product> products = {};  // of effects that are not asked of the twin
  std::vector<KnownAngle> angles;      // at least one; the bench goes through the first
  double plausible = 0.0;              // rms of a disturbance that nobody thought of, SI
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
