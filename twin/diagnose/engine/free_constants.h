#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "twin/diagnose/engine/followed.h"

/// The constants that a run leaves free (where an artefact stands, what an axis errs): each enters the twin at a
/// point, times a course of its own.
namespace twinbench::diagnose {

/// A point and the courses of the constants that are free there.
struct FreePoint {
  model::Point point;
  Eigen::MatrixXd courses;  // used readings x constants, dimensionless
  std::string of;           // in words: "a mounting"
  double sd = kNaN;         // SI: what each constant may well be; NaN: anything
};

struct FreeConstants {
  std::vector<FreePoint> points;
  Eigen::VectorXd values;   // SI, those of a point side by side
  Eigen::MatrixXd columns;  // rows (reading i, channel c: i * channels + c) x constants: d row / d constant
  Eigen::MatrixXd fitted;   // constants x those directions of them that the readings show

  /// Calls use(point, its part of `constants`) for each point.
  template <class Use>
  void ForEach(const Eigen::VectorXd& constants, Use use) const {
    Eigen::Index from = 0;
    for (const FreePoint& p : points) {
      use(p, constants.segment(from, p.courses.cols()));
      from += p.courses.cols();
    }
  }

  /// As the twin is told them.
  std::vector<model::Disturbance> Disturbances() const;

  /// 1 / sd^2 of each constant, 0 of those that may be anything.
  Eigen::VectorXd Precision() const;
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
