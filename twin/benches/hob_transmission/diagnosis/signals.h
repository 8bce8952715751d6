#pragma once

#include <Eigen/Core>
#include <vector>

#include "twin/benches/hob_transmission/diagnosis/grouping.h"
#include "twin/benches/hob_transmission/settings.h"
#include "twin/core/scenario.h"
#include "twin/diagnose/engine/linear_run.h"

/// What causes do to the samples of a hobbing machine's transmission chain, written here a second time: the twin's
/// own code is not asked. A signal has one entry a used sample, in rad of m = table encoder - ratio x hob encoder.
namespace twinbench::diagnose::hob {

inline constexpr int kLowOrders = 12;  // always looked at, whatever the gears have

/// Channels: the encoders' m and, where it was recorded, what the interferometer saw.
inline constexpr const char* kTransmission = "transmission";
inline constexpr const char* kInterferometer = "interferometer";

/// Who sees a signal: the interferometer knows the table's true motion, but nothing of the encoders.
enum class ShownBy { kByEncoders, kByBoth, kByInterferometer };

/// The circumstances that signals depend on; one entry a sample.
struct SignalContext {
  Schedule schedule;               // target: table, reference: hob
  Eigen::VectorXd table_rad;       // as its encoder showed it, counted from the table's origin
  Eigen::VectorXd ring_rad;        // the same from the reading head: the table ring's own angle
  Eigen::VectorXd hob_rad;         // as its encoder showed it
  Eigen::VectorXd steady_hob_rad;  // the same without the noise of single samples (steady_hob.h)
  Eigen::VectorXd velocity_rad_s;  // of the table
  Eigen::VectorXd direction;       // +1, -1; at rest that of the last motion
  TransmissionSettings train;
  int hob_lines = 1;
  double ramp_s = 0.0;  // a pass ends in one of these beyond its last sample
  int channels = 1;
  Grouping groups;  // of the samples into rows of the run

  Eigen::Index Samples() const { return table_rad.size(); }
};

/// Phase of the sine and cosine of the hob's encoder, in rad of their period.
Eigen::VectorXd HobSignalPhase_rad(const SignalContext& context);

/// Angle by which faulty signals mislead, in rad of their period, to first order and for unit faults: samples x 4,
/// offset of the sine, of the cosine, ratio of the amplitudes - 1, lead of the sine.
Eigen::MatrixXd SignalFaults_rad(const SignalContext& context);

/// State of a hysteresis that goes over to the sense of the motion with the way travelled,
///     d state / d way = (sense - state) / settles_over,   first state 0.
/// @param ramp_s  Before a reversal the table runs out over the way of a ramp, and comes back over it.
Eigen::VectorXd Relaxation(const SignalContext& context, double settles_over_rad, double ramp_s);

/// Travel of the table since its last reversal, with the way of the ramp [rad].
Eigen::VectorXd TravelSinceReversal_rad(const SignalContext& context);

/// Samples x set-ups, one where it belongs.
Eigen::MatrixXd SetUps(const SignalContext& context);

/// Signals of samples as rows of the run: averaged over groups, on the channels that see them.
/// @param samples  Samples x any.
Eigen::MatrixXd AsRows(const SignalContext& context, const Eigen::MatrixXd& samples, ShownBy shown_by);

}  // namespace twinbench::diagnose::hob
