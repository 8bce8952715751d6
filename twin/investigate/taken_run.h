#pragma once

#include <Eigen/Core>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "twin/diagnose/engine/projector.h"
#include "twin/investigate/hypothesis.h"
#include "twin/investigate/means.h"

namespace twinbench::investigate {

/// The number of a run that was not made yet.
inline constexpr int kToCome = std::numeric_limits<int>::max();

/// A run beside what was believed when the investigation began: of the bench, or a planned one of the twin.
struct TakenRun {
  plan::NextRun asked;
  int number = kToCome;  // which of the investigation's, from 0 on
  Scenario scenario;  // without any hypothesis
  std::vector<Reading> readings;
  double minutes = 0.0;  // by the procedure's own clock
  diagnose::LinearRun linear;
  diagnose::NoiseModel noise;
  std::shared_ptr<const diagnose::Projector> projector;
  Eigen::VectorXd left;  // white: the residual of `scenario`
};

/// @param number  Which of the investigation's, from 0 on.
/// @throws InputError as Means::against does.
TakenRun TakenOf(const plan::NextRun& asked, const Scenario& scenario, std::vector<Reading> readings,
                 const Means& means, int number = kToCome);

/// Takes the weight from rows that a diagnosis of the run holds for single disturbed ones: no fit is to follow
/// them.
void StrikeOutliers(const diagnose::NoiseModel& found, TakenRun& run);

/// What the hypothesis leaves of the run's readings, white, in the run's own frame. Where it cannot be followed, or
/// shows other readings, it explains nothing.
Eigen::VectorXd LeftBy(const Hypothesis& hypothesis, const TakenRun& run, const Means& means);

/// How many runs like `first` it is worth for finding what is faint in one: how much less the noise of its readings
/// is, at the same stops, or how many more of them there are in the same motion. 1 if it is such a run, 0 where the
/// stops are others.
double WorthOf(const TakenRun& run, const TakenRun& first);

/// a' W b, W what is left when the free unknowns have taken their share.
Eigen::MatrixXd Product(const TakenRun& run, const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

}  // namespace twinbench::investigate
