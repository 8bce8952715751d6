#pragma once

#include "twin/benches/encoder_comparison/diagnosis/second_order.h"
#include "twin/diagnose/diagnose.h"
#include "twin/diagnose/engine/family.h"

namespace twinbench::diagnose::encoder {

/// So many columns in time that they follow any walk.
bool FollowsWalk(const Family& family, const Eigen::MatrixXd& columns);

/// Noise whose memory is nearly as long as the run is no noise of readings: it is told as what it is, a random walk
/// without a name. A cause that such a walk may well be by chance is no surer than that.
/// @param bent  What the causes are not exactly walks nowhere. The file shows the walk as a course of these
/// readings.
void TellWander(const SecondOrder& bent, DiagnosisRun& result);

}  // namespace twinbench::diagnose::encoder
