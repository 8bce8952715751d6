#pragma once

#include <optional>
#include <vector>

#include "twin/benches/encoder_comparison/diagnosis/encoder_run.h"
#include "twin/diagnose/diagnose.h"

/// A servo that is commanded faster than it can go: it follows at its own greatest speed, however far behind it is.
/// No sum of causes of the catalogue is like that.
namespace twinbench::diagnose::encoder {

struct SpeedLimit {
  EncoderRun asked;              // the run as it was recorded
  std::vector<Reading> allowed;  // the same readings, beside where the limit lets the device be
  Eigen::VectorXd behind_rad;    // by used reading: what the limit and the delay make of the error
  double speed_rad_s = 0.0, delay_s = 0.0;
};

/// @return the limit, if it and a delay leave a tenth of what any delay alone leaves and a twentieth of the error.
std::optional<SpeedLimit> SpeedLimitOf(const std::vector<Reading>& readings, const Scenario& scenario,
                                       const model::FollowMaker& follow);

/// Before the causes that were found beside what the limit allows.
void TellSpeedLimit(const SpeedLimit& limit, DiagnosisRun& result);

}  // namespace twinbench::diagnose::encoder
