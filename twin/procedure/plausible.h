#pragma once

#include "twin/procedure/options.h"

namespace twinbench::procedure {

/// @throws DeviceFault kImplausible for a room that no bench stands in, or a spot that jumped from one stop to the
///         next of the same pass; kClock for a block that began outside the time in which it was asked for.
void RequirePlausible(const Reading& reading, const Reading& before, const Options& options);
/// @throws DeviceFault kClock for a sample of an instrument that is stamped outside the time in which it was taken: by a clock
///         of its own, or one that has jumped.
void RequireTimely(const Reading& sample, Time from, Time to);
void RequireTimely(const Acquisition& block, Time asked, Time answered);

/// @throws DeviceFault kGap for a reading of a real bench in which a column that its bench must show is empty without a reason: the
///         mirror is out of view, the table was not seated at its tooth, the machine stands elsewhere than its encoders say.
void RequireShown(const Reading& reading, const std::string& bench);

/// @param before  The sample before, of one at every so many lines of an encoder that the instruments count.
/// @throws DeviceFault kProtocol of one at whose line - what the bench shows first - that sample was taken, too.
void RequireAnother(const Reading& sample, const Reading& before, const std::string& bench);

/// @param lines     From one sample to the next.
/// @param step_rad  Of the first two samples, which is made if it is NaN.
/// @throws DeviceFault kGap of a sample that is half a line or more nearer to that before, or further away, than
/// the second to the first.
void RequireNextLine(Reading sample, Reading before, const std::string& bench, int lines, double& step_rad);

/// @param before  The reading before, of a bench whose reference is read and not commanded. The encoder of its axis was looked at
///                about both.
/// @throws DeviceFault kMoved if from one to the next the reference did not go the way that the encoder went.
void RequireTogether(const Reading& reading, const Reading& before, const std::string& bench);

}  // namespace twinbench::procedure
