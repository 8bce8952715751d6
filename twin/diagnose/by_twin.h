#pragma once

#include <Eigen/Core>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "twin/core/bench_format.h"
#include "twin/diagnose/diagnose.h"
#include "twin/diagnose/engine/bent_waves.h"
#include "twin/diagnose/engine/linear_run.h"
#include "twin/diagnose/tuning.h"
#include "twin/model/follow.h"

/// A diagnosis put together from what every bench has anyway: its format, its catalogue and its twin that follows
/// the record. A bench that has more to say (motions that are free at every stop, causes with signatures of their
/// own) builds its run and its families itself.
namespace twinbench::diagnose {

struct BelievedRecord;
struct Compared;
struct Family;
struct TimeSeries;
namespace unknown {
struct Design;
}

/// What a bench says so that its readings are compared with its twin's. Channels are those of its format; unless
/// `shown` says otherwise they are read in the format's columns that a bench must show, in the same order.
struct TwinComparison {
  /// An angle that structure may be locked to, and where a reading keeps it.
  struct KnownAngle {
    std::string name;  // of the format's angles; empty: the twin has no signals that are synchronous with it
    std::function<double(const Reading&)> rad;
    std::string words = {};               // empty: the name and "angle"
    std::string harmonics = "harmonic";   // sort of its whole orders
    int first_unfree = 1;                 // the first whole order that no constant of the run takes up; 0: none
    bool is_turned_by_motion = true;      // false: direction and speed are of another angle
    int lowest_order = 1;  // of waves without a name; those below are causes of the catalogue, together, whatever their phase
  };

  /// A point whose value at each reading is a sum of stated courses times constants that all set-ups share: an
  /// error that is a polynomial of its axis.
  struct FreeCourses {
    std::string point;
    std::function<Eigen::MatrixXd(const std::vector<Reading>&)> courses;  // readings x constants, dimensionless
    std::string of = "the bench";                                         // in words, behind the name of the point
    double sd = kNaN;  // SI: what each constant may well be; NaN: what `free_sd` says
  };

  /// Points with a constant of their own at every place that readings come back to: errors of a table's positions.
  struct FreePlaces {
    std::vector<std::string> points;
    std::function<std::vector<int>(const std::vector<Reading>&)> place;  // of each reading, numbered as you like
    std::string of;                                                      // in words: "a position"
  };

  /// A constant of the bench, of either sign, that is known to some extent: as an effect of the catalogue. It is
  /// nothing while the others are fitted, and free within `sd` [SI] beside the causes.
  struct KnownConstant {
    std::string effect, where, parameter;
    double sd;
  };

  /// What is drawn anew at each reading, at a point [SI].
  struct Scatter {
    std::string point;
    double sd;
    bool (*is_at)(const Reading&) = nullptr;  // null: at all of them
  };

  /// An effect of the catalogue that is nothing but more of it than stated.
  struct ScatterCause {
    std::string effect, parameter, point;
  };

  /// An effect of the catalogue as a point times courses that depend on one shape, where asking the twin anew at
  /// every value of the shape would take too long: a wave whose period is not known.
  struct Product {
    std::string effect, where, point;
    std::vector<std::string> sizes;  // parameters in the unit of the point, one a course
    std::string shape;               // the parameter that courses depend on
    std::function<std::vector<double>(const std::vector<Reading>&)> values;                  // SI, to be tried
    std::function<Eigen::MatrixXd(const std::vector<Reading>&, double shape)> courses = {};  // readings x sizes
    bool is_wave = false;   // courses are the cosine and the sine of "amplitude" and "phase"
    bool is_order = false;  // a wave whose shape is a whole number
  };

  /// A place of the effect "tone", or "slip", that is nothing but a wave, or a step, in what channels show.
  struct ShownOn {
    std::string where;
    Eigen::MatrixXd pattern;  // channels x 1: what each shows of it; of a tone also x tones of a size of their own
    bool is_sine = false;     // the catalogue counts the phase of a sine
  };

  /// An effect that is nothing but a step of a parameter at a point, from "at_reading" on.
  struct StepAt {
    std::string effect, where, point, parameter;
  };

  /// A way of a body to move, as the channels show it.
  struct Motion {
    std::string name, point;
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

  /// Of a bench that is read in motion, thousands of times a pass: neighbours are taken together (grouping.h), once
  /// single values that lie far outside have been left out.
  struct Sampled {
    std::function<Eigen::VectorXd(const std::vector<Reading>&)> line_rad;    // phase of the fastest wave that stays
    std::function<Eigen::VectorXd(const std::vector<Reading>&)> folded_rad;  // of one that the sampling folds
    std::function<Eigen::VectorXd(const std::vector<Reading>&)> travel_rad;  // since the last reversal
  };

  /// A whole order by turns of the first angle that is tabulated, and what it may mean.
  struct TabulatedOrder {
    int order;
    std::string meaning;
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
  std::function<std::vector<Scatter>(const Scenario&)> scatter = {};              // beside it
  std::optional<ScatterCause> scatter_cause = {};

  // Of a bench whose free constants are many, or not all told apart.
  std::vector<FreeCourses> free_courses = {};
  std::optional<FreePlaces> free_places = {};               // then `free_sd` holds all constants
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
  std::vector<ShownOn> tones = {}, steps = {};
  std::vector<StepAt> steps_at = {};
  std::vector<Motion> motions = {};      // what structure is told by; empty: the channels
  std::vector<KnownConstant> known = {};

  // Of a bench with channels that not every run or reading has. Those that are used show the first.
  std::vector<std::string> channels = {};                // the first ones that the twin shows; empty: the format's
  std::function<bool(const Reading&)> is_used = {};      // empty: if every channel is shown
  bool is_alike_on_all = false;                          // structure without a name may show so on all channels
  // What the channels show is what is wrong: it has no scale of its own that errors may go by.
  bool shows_errors = false;
  bool remounting_ends_tones = false;                    // size and phase are of each set-up
  std::function<void(Reading&, const Eigen::VectorXd&)> show = {};  // the reverse of `shown`, for what a reading
                                                                    // should have been: causes are asked of that
  std::vector<std::string> nulled = {};  // channels that are kept at zero, so that no error goes by them
  std::optional<Sampled> sampled = {};
  std::vector<TabulatedOrder> orders = {};
  // What is thought of causes of the catalogue.
  bool sizes_by_trace = false;  // `plausible` is what each leaves: devices may be of any quality
  bool alike_by_trace = false;  // the same at any shape: what decays before it is read may have been large
  double asked_points = tuning::kAskedPoints;  // of a grid over all shapes of an effect that the twin is asked for
  std::function<double(const std::string& effect, const std::string& where)> listed = {};  // see Family
  std::map<std::string, std::string> named = {};                                           // see unknown::Design
  int most_causes = 4;
  std::function<bool(const std::string& effect)> may_bend = {};  // so that the twin is asked about it again; empty: any
  BentWaves bent = {};
  bool together = false;  // see SearchExtent; and the search goes on about all causes without a shape that were found
  bool bends = false;  // the first cause is searched about itself wherever it is off its tangent by more than noise
  std::function<std::string(const std::string& effect, const std::string& rival)> next_measurement = {};
  std::function<std::string(const std::string& effect)> shown_by = {};  // what would show it; empty: nothing simple
  std::vector<std::string> unrecorded = {};  // effects that nobody can name without what this record lacks

  // Of a bench with more to say. Effects that have families of its own are asked of nobody else.
  std::function<std::vector<Family>(const Compared&, const BelievedRecord&, const TimeSeries&)> own_families = {};
  std::function<void(const Compared&, unknown::Design&)> structure = {};  // on what structure without a name may show
  std::function<std::vector<Reading>(std::vector<Reading>)> at_their_times = {};  // empty: those that are recorded
  double rounding = 0.0;                                                          // SI: step of the readings
};

/// An effect without a size that makes another bench of it: it is believed or it is not.
struct Alternative {
  std::string effect, where;
  bool is_gross = false;  // only tried where hardly anything fits, and then so plain that nothing is searched for
};

/// The comparison where a scenario is believed.
using ComparisonOf = std::function<TwinComparison(const Scenario&)>;

/// Readings against the twin's, with the free constants that fit best.
/// @throws InputError if fewer than 12 readings have every value that the bench must show, or the twin shows
/// nothing
///         where a reading has one.
LinearRun CompareWithTwin(const std::vector<Reading>& readings, const Scenario& scenario,
                          const TwinComparison& comparison);

/// @throws InputError as above, or if the design has no redundancy.
DiagnosisRun DiagnoseByTwin(const std::vector<Reading>& readings, const Scenario& scenario,
                            const DiagnoseOptions& options, const TwinComparison& comparison);

/// The same where one of the alternatives may explain more than the scenario does.
/// @param decided  What the bench has found before.
DiagnosisRun DiagnoseByTwin(const std::vector<Reading>& readings, const Scenario& scenario,
                            const DiagnoseOptions& options, const ComparisonOf& comparison_of,
                            const std::vector<Alternative>& alternatives, const std::vector<Cause>& decided = {});

}  // namespace twinbench::diagnose
