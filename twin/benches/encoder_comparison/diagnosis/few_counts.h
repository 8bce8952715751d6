#pragma once

#include <Eigen/Core>

#include "twin/diagnose/extend.h"

/// A coarse device that is read at a few places over and over shows few values: too few to see its count from (CommonStep), and
/// none of them says where within a count it stands.
namespace twinbench::diagnose::encoder {

/// The step between values that are shown again and again, if those of all places are whole steps apart.
/// @return 0 if there is none, or if there are so many values that CommonStep would see it.
double CountOfFewValues(const Eigen::VectorXd& shown_rad);

/// What is no larger than a device that stands still may be off by its counts is not sure.
void DoubtFewCounts(const Eigen::VectorXd& shown_rad, DiagnosisRun& result);

}  // namespace twinbench::diagnose::encoder
