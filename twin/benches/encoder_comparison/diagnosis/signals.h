#pragma once

#include <Eigen/Core>
#include <limits>
#include <vector>

#include "twin/benches/encoder_comparison/settings.h"
#include "twin/core/scenario.h"
#include "twin/diagnose/engine/linear_run.h"

/// What causes do to the readings of an angle comparison, written here a second time: the twin's own code is not
/// asked. A signal has one entry a used reading, in rad of measured - reference.
namespace twinbench::diagnose::encoder {

/// The circumstances that signals depend on.
struct SignalContext {
  std::vector<int> reading, setup, pass, direction;
  Eigen::VectorXd time_s;         // from the first used reading
  Eigen::VectorXd since_start_s;  // from time 0 of the record
  Eigen::VectorXd reference_rad;
  Eigen::VectorXd device_rad;      // angle of the device's scale, without its errors
  Eigen::VectorXd velocity_rad_s;  // zero where it was not recorded
  Eigen::VectorXd acceleration_rad_s2;  // on the way from the reading before
  Eigen::VectorXd above_K;         // temperature above the reference; empty if none was logged
  DeviceSettings device;
  bool has_clock = true;  // false: times count the rows
  bool has_means = false;  // a reading in motion is the mean over the way to the next

  Eigen::Index Readings() const { return reference_rad.size(); }
  bool Moves() const { return velocity_rad_s.cwiseAbs().maxCoeff() > 0.0; }
};

/// @param device_rad  One a reading of the schedule.
SignalContext ContextOf(const Schedule& schedule, const Eigen::VectorXd& device_rad, const DeviceSettings& device);

/// Sense of the motion as recorded, 0 at rest.
Eigen::VectorXd Goes(const SignalContext& context);

/// Phase of the device's sine and cosine, in rad of their period.
Eigen::VectorXd SignalPhase_rad(const SignalContext& context);

/// Sense of the motion as recorded, +1 or -1; at rest that of the last motion, or 0.
Eigen::VectorXd Sense(const SignalContext& context, bool holds_at_rest);

/// The ways in which a reading may remember a sense, those that differ on this schedule: that of the recorded
/// direction, kept at rest; the same, forgotten at rest; that of the straight way from the reading before, so that
/// the first stop behind a reversal, if nothing moved, still has the old one.
std::vector<Eigen::VectorXd> Senses(const SignalContext& context);

/// Travel since the last reversal, in rad; the way to the first reading is taken as none. Passes of one direction
/// that follow each other without a way back between them are one travel.
Eigen::VectorXd TravelSinceReversal_rad(const SignalContext& context);

/// State of a hysteresis that goes over to the sense of the motion with the way travelled,
///     d state / d way = (sense - state) / settles_over,   first state 0,
/// and what an unknown first state adds to it: readings x 2. The way between readings is straight, but a stop is
/// approached over the last `run_up_rad` in its direction.
Eigen::MatrixXd Relaxation(const SignalContext& context, double settles_over_rad, double run_up_rad);

/// What a move leaves, with its sense, and how it dies out while the reference stands: 1 in motion and at the first
/// reading of a stop.
Eigen::VectorXd Settling(const SignalContext& context, double time_constant_s);

/// How long the reference had stood at each reading since the first one there [s].
Eigen::VectorXd Standing_s(const SignalContext& context);

/// Where a follower with play stands behind (-) or before (+) the shaft, in shares of the way `crossed_over_rad`
/// that the shaft goes until it is dragged along: the play operator, -0.5 to 0.5. `start` is where in the gap it
/// begins, -1 behind to 1 before; the way between readings is as in Relaxation.
Eigen::VectorXd Play(const SignalContext& context, double crossed_over_rad, double start, double run_up_rad);

/// Half the usual distance of neighbouring stops, half a turn at one place that was reached from both sides, 0 if the
/// shaft moved while it was read.
double RunUp_rad(const SignalContext& context);

/// Sine and cosine of phase p as they are: (1 + ratio) sin(p + quadrature) + offset_sin and cos p + offset_cos,
/// both cut off at `level`.
struct SignalFaults {
  double offset_sin = 0.0, offset_cos = 0.0, ratio = 0.0, quadrature_rad = 0.0;
  double level = std::numeric_limits<double>::infinity();
};

/// Error of atan2 from them, in rad of their period.
Eigen::VectorXd SignalError_rad(const Eigen::VectorXd& phase_rad, const SignalFaults& faults);

/// Error of atan2 from sine and cosine that are cut off at `level` of their amplitude, in rad of their period: a
/// series of orders 4, 8, 12 whose ratios follow from the level.
Eigen::VectorXd ClippingError_rad(const Eigen::VectorXd& phase_rad, double level);

}  // namespace twinbench::diagnose::encoder
