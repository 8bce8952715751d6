#pragma once

#include "twin/procedure/options.h"

namespace twinbench::procedure {

/// @throws DeviceFault kImplausible for a room that no bench stands in, or a spot that jumped from one stop to the
///         next of the same pass; kClock for a block that began outside the time in which it was asked for.
void RequirePlausible(const Reading& reading, const Reading& before, const Options& options);
void RequireTimely(const Acquisition& block, Time asked, Time answered);

}  // namespace twinbench::procedure
