#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "twin/diagnose/engine/followed.h"
#include "twin/diagnose/engine/linear_run.h"

/// The constants that a run leaves free (where an artefact stands, what an axis errs): each enters the twin at a
/// point, times a course of its own.
namespace twinbench::diagnose {

/// A point and the courses of the constants that are free there.
struct FreePoint {
  model::Point point;
  Eigen::MatrixXd courses;  // used readings x constants, dimensionless
  std::string of;           // in words: "a mounting"
  double sd = kNaN;         // SI: what each constant may well be; NaN: anything
  bool is_local = false;    // one constant a place, and no reading sees two of them
};

struct FreeConstants {
  std::vector<FreePoint> points;  // local ones first, with the same places and an sd; then all others have one, too
  Eigen::VectorXd values;   // SI, those of a point side by side
  Eigen::MatrixXd columns;  // rows (reading i, channel c: i * channels + c) x constants: d row / d constant
  Eigen::MatrixXd fitted;   // constants x those directions of them that the readings show
  std::vector<Eigen::Index> told = {};  // those directions if each is a constant by itself; else empty

  /// Calls use(point, its part of `constants`) for each point.
  template <class Use>
  void ForEach(const Eigen::VectorXd& constants, Use use) const {
    Eigen::Index from = 0;
    for (const FreePoint& p : points) {
      use(p, constants.segment(from, p.courses.cols()));
      from += p.courses.cols();
    }
  }

  /// As the twin is told them, or constants of other values.
  std::vector<model::Disturbance> Disturbances() const { return DisturbancesOf(values); }
  std::vector<model::Disturbance> DisturbancesOf(const Eigen::VectorXd& constants) const;

  /// 1 / sd^2 of each constant, 0 of those that may be anything.
  Eigen::VectorXd Precision() const;
  /// The values in the directions that are fitted.
  Eigen::VectorXd FittedValues() const;
  /// What the rows show of those directions. Constants that may be anything are hardly held: a millionth of what
  /// one reading says.
  /// @param weights  Of the rows, 1 / noise. @param hold  As in FreeFit.
  Nuisance AsNuisance(const Eigen::VectorXd& weights, double hold = 1.0) const;
};

/// How they are fitted.
struct FreeFit {
  Eigen::VectorXd weights;  // of the rows: 1 / noise, or all alike
  double rank = 1e-10;      // directions that show less, of the one that shows most, are not fitted
  int rounds = 2;           // each with slopes about what the last one found
  double hold = 1.0;        // so many times tighter than their sd the constants are held
};

/// @param observed  Rows that the readings showed, SI.
/// @return the constants that fit best, held by their sd; of directions that nothing shows, the least.
/// Gauss-Newton with the twin's slopes and shortened steps: nothing stays of first order.
FreeConstants FitFree(const Followed& twin, std::vector<FreePoint> points, const Eigen::VectorXd& observed,
                      const FreeFit& how);

}  // namespace twinbench::diagnose
