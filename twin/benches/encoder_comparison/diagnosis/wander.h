#pragma once

#include "twin/benches/encoder_comparison/diagnosis/second_order.h"
#include "twin/diagnose/diagnose.h"
#include "twin/diagnose/engine/family.h"

namespace twinbench::diagnose::encoder {

/// So many columns in time that they follow any walk.
bool FollowsWalk(const Family& family, const Eigen::MatrixXd& columns);

/// Whether the readings walk and no frequency of what they do from one to the next, nor from some to the next, stands out of
/// those near it, no step and no drift: then all that has a name may be no more than a piece of that walk.
bool IsNothingButWalk(const LinearRun& run);

/// Noise whose memory is nearly as long as the run is no noise of readings: it is told as what it is, a random walk
/// without a name. A cause that such a walk may well be by chance is no surer than that.
/// @param bent  What the causes are not exactly walks nowhere. The file shows the walk as a course of these
/// readings.
void TellWander(const SecondOrder& bent, DiagnosisRun& result);

}  // namespace twinbench::diagnose::encoder
