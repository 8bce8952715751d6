#pragma once

#include <vector>

#include "twin/benches/encoder_comparison/diagnosis/glitches.h"
#include "twin/benches/encoder_comparison/diagnosis/signals.h"
#include "twin/model/follow.h"

/// The forward model of an angle comparison: an ideal device, turned on the shaft by an unknown angle at each
/// set-up, with the effects that the scenario already knows.
namespace twinbench::diagnose::encoder {

struct EncoderRun {
  LinearRun run;  // one channel, "angle", in deg; one unknown a set-up: its offset
  SignalContext context;
  int left_out = 0;   // readings without a value
  Glitches glitches;  // bridged in all that follows

  std::vector<Reading> used;   // as the twin follows them
  Eigen::VectorXd error_rad;   // measured - reference
  Eigen::VectorXd offset_rad;  // where the device stands on the shaft

  Eigen::SparseMatrix<double, Eigen::RowMajor> setups;  // rows x set-ups: 1 where a reading is in one
  Eigen::MatrixXd targets;  // rows x targets whose errors are free: 1 where a reading is at one; may be none

  /// Free are the offsets of the set-ups and nothing else.
  Nuisance SetUpsAlone() const;
  /// What the offsets of the set-ups leave of rows.
  Eigen::VectorXd BesideSetUps(const Eigen::VectorXd& rows) const;
};

/// `observed` is the device's angle with the turns that it does not count put back. Where the noise is not known it
/// is estimated from neighbouring readings, which slow structure does not reach (noise_estimate.h). Velocities that
/// were not recorded are taken from the angles if the scenario says sweep.
///
/// @param follow  The twin that says what readings should have been.
/// @throws InputError if fewer than 12 readings have a value.
EncoderRun BuildRun(const std::vector<Reading>& readings, const Scenario& scenario,
                    const model::FollowMaker& follow);

/// What the twin's device shows beside the reference at the readings of the run.
struct ErrorOfTwin {
  Eigen::VectorXd error_rad;
  Eigen::VectorXd offset_rad;  // where the device then stands on the shaft, by reading
};

inline constexpr double kSameOffset_rad = 1e-10;

/// The device is set up where the readings say: the mean of what it shows in a set-up, less the mean of the errors
/// that the scenario has (those of a quadrature error are not zero).
/// @param offset_rad  Where it may stand: it is moved until it is there to `same_rad`.
ErrorOfTwin FollowTwin(const EncoderRun& encoder, const Scenario& scenario, const model::FollowMaker& follow,
                       const Eigen::VectorXd& offset_rad, double same_rad = kSameOffset_rad);

}  // namespace twinbench::diagnose::encoder
