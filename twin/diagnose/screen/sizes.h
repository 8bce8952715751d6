#pragma once

#include <string>

#include "twin/diagnose/engine/linear_run.h"
#include "twin/diagnose/screen/screen.h"

/// Sizes on a channel as lengths and as angles.
namespace twinbench::diagnose::screen {

/// "0.42 um": a value of the readings in the run's unit.
std::string Amount(const LinearRun& run, double value_SI);

/// True for the patterns that are rotations: yaw, tilt, roll.
bool IsAngle(const std::string& pattern);

/// What a size on one channel amounts to as an angle: of the rotation that moves that channel most, or the size
/// itself where readings are angles; NaN if there is neither.
double AsAngle(const LinearRun& run, int channel, double size_SI);

/// A size on one channel, as a length (NaN where readings are angles) and as an angle.
void SetEffect(const LinearRun& run, int channel, double size_SI, ScreenTest& test);

/// The size of a body's motion by its pattern: as a length that of the channel that shows it most.
void SetEffect(const LinearRun& run, const Pattern& pattern, double amplitude, ScreenTest& test);

/// The channel of which a unit of noise is most as an angle: for sizes that belong to no channel.
int AnyChannel(const LinearRun& run);

/// Rows of one channel.
inline auto RowsOf(const LinearRun& run, int channel) {
  return Eigen::seqN(channel, run.schedule.Readings(), run.Channels());
}

/// Typical standard uncertainty of a channel's readings, SI.
double TypicalSigma(const LinearRun& run, int channel);

/// Deviation of what comes beside noise of this deviation and makes it `ratio` times as large, or as small.
double Beside(double sigma, double ratio);

}  // namespace twinbench::diagnose::screen
