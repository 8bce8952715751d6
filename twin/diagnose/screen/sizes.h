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

/// True if the readings are angles themselves.
bool ReadsAngles(const LinearRun& run);

/// What a size on one channel amounts to as an angle: of the rotation that moves that channel most, or the size
/// itself where readings are angles; NaN if there is neither.
double AsAngle(const LinearRun& run, int channel, double size_SI);

/// A size on one channel, as a length and as an angle.
void SetEffect(const LinearRun& run, int channel, double size_SI, ScreenTest& test);

/// The channel of which a unit of noise is most as an angle: for sizes that belong to no channel.
int AnyChannel(const LinearRun& run);

/// Typical standard uncertainty of a channel's readings, SI.
double TypicalSigma(const LinearRun& run, int channel);

}  // namespace twinbench::diagnose::screen
