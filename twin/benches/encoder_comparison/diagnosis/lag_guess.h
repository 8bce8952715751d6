#pragma once

#include <optional>

#include "twin/benches/encoder_comparison/diagnosis/encoder_run.h"

namespace twinbench::diagnose::encoder {

/// A device that follows so late that the motion has changed meanwhile: the speed of a moment says little of how far it is behind.
struct LagGuess {
  double delay_s = 0.0;
  double gain = 1.0;  // of what it shows then
};

/// The delay, and the gain beside it, with which the reference's own course leaves least of what the device shows.
/// @return nothing if the speed and a gain leave less than twice as much, or if the reference stands or has no clock.
std::optional<LagGuess> GuessLag(const EncoderRun& encoder);

}  // namespace twinbench::diagnose::encoder
