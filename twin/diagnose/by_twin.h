#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "twin/core/bench_format.h"
#include "twin/diagnose/diagnose.h"
#include "twin/diagnose/engine/linear_run.h"
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

  /// A place of the effect "tone" that is nothing but a wave in what channels show.
  struct ToneOn {
    std::string where;
    Eigen::MatrixXd pattern;  // channels x 1: what each shows of it
  };

  /// The same over several shapes at once.
  struct ShapedProduct {
    std::string effect, where, point;
    std::vector<std::string> sizes, shapes;
    Eigen::MatrixXd values;  // to be tried, SI: grid points x shapes
    std::function<Eigen::MatrixXd(const std::vector<Reading>&, const Eigen::VectorXd& shape)> courses = {};
  };

  /// A number of each reading that structure without a name may go by: where an axis stands.
  struct Coordinate {
    std::string name, unit;
    double to_SI = 1.0;
    std::function<double(const Reading&)> value;
  };

  /// Structure without a name at a point, periodic in a coordinate.
  struct FringesAlong {
    std::string point;
    Coordinate along;
    double shortest, longest;
  };

  const BenchFormat* format = nullptr;  // never null
  model::FollowMaker follow;
  std::string unit;  // of values in reports: "um"
  double to_SI = 1.0;
  std::vector<ChannelUnit> units =
      {};              // of each channel where they are unlike; then nothing else is told in `unit`
  double noise = 0.0;  // stated standard uncertainty of one reading, SI; 0: taken from the readings
  std::vector<std::string> free_points;  // a constant of each set-up is free there
  std::vector<KnownAngle> angles;        // the first is the one that the bench goes through
  double plausible = 0.0;                // rms of a disturbance that nobody thought of, SI

  // Of a bench that shows other things in other set-ups, or channels of unlike noise: one value a channel, SI.
  std::function<Eigen::VectorXd(const Reading&)> shown = {};                      // NaN: not shown
  std::function<Eigen::VectorXd(const Scenario&, const Reading&)> noise_of = {};  // counts instead of `noise`

  // Of a bench whose free constants are many, or not all told apart.
  std::vector<FreeCourses> free_courses = {};
  std::function<double(const model::Point&)> free_sd = {};  // SI: what a constant may well be; empty: anything
  double free_rank = 1e-10;            // directions that show less, of the one that shows most, are not fitted
  int free_rounds = 2;                 // of the fit, each with slopes about what the last one found
  std::vector<Product> products = {};  // of effects that are not asked of the twin
  std::vector<ShapedProduct> shaped_products = {};  // likewise
  // Structure without a name at a point, that goes by two coordinates together; by one alone it is free.
  std::vector<std::string> interaction_points = {};
  std::vector<Coordinate> coordinates = {};
  std::vector<FringesAlong> fringes = {};
  std::string outliers = {};  // the point at which the catalogue's outliers enter; empty: the readings
  std::vector<ToneOn> tones = {};
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
