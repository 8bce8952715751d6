#pragma once

#include <Eigen/Core>

#include "twin/diagnose/engine/linear_run.h"

namespace twinbench::diagnose {

/// @param used  Of `all` readings those that have a value.
/// @throws InputError if they are fewer than twelve.
void RefuseTooFew(std::size_t used, std::size_t all);

/// What a design leaves over for a diagnosis.
struct DesignCount {
  int setups = 0;
  int passes = 0;           // the most that a set-up has
  int rows = 0;             // of full-circle readings
  double redundancy = 0.0;  // of these rows that the free unknowns cannot follow, in degrees of freedom
};

/// @param redundancy  By row of the run, Projector::Redundancy().
DesignCount CountDesign(const LinearRun& run, const Eigen::VectorXd& redundancy);

/// Stops where the free unknowns can follow anything that the full circles may show: with two set-ups, one
/// direction and one pass each, 8 n readings meet 8 n unknowns, and every hidden cause goes into the separated
/// errors.
///
/// @throws InputError with the count and the smallest addition to the measurement that would help, if full-circle
///         rows are there and fewer than one degree of freedom is left in a hundred of them.
void RefuseWithoutRedundancy(const LinearRun& run, const Eigen::VectorXd& redundancy);

}  // namespace twinbench::diagnose
