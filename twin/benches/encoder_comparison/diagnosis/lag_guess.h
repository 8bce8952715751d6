#pragma once

#include <optional>
#include <vector>

#include "twin/benches/encoder_comparison/diagnosis/encoder_run.h"
#include "twin/diagnose/engine/family.h"

namespace twinbench::diagnose::encoder {

/// A device that follows so late that the motion has changed meanwhile: the speed of a moment says little of how far it is behind.
struct LagGuess {
  double delay_s = 0.0;
  double lag_s = 0.0;  // of first order, behind the delay
  double gain = 1.0;   // of what it shows then
  double per_acceleration_s2 = 0.0, friction_rad = 0.0;  // behind in proportion to the acceleration, and in the sense of the motion
};

/// The delay or the lag of first order, or where neither alone does as well both, and the gain beside it, with which the
/// reference's own course leaves least of what the device shows; with its acceleration and its sense where they leave clearly less.
/// @return nothing if the speed and a gain leave hardly more, or if the reference stands or has no clock.
/// @param families  Of the run: which following errors it can show.
std::optional<LagGuess> GuessLag(const EncoderRun& encoder, const std::vector<Family>& families);

/// What is late by the one, told as the other.
struct OtherLag {
  LagGuess guess;
  bool leaves_less = false;
  bool is_told_apart = false;  // beside the memory of what is left
};

/// @param shown_rad  By reading, without the errors of other causes.
/// @param is_delay   What it is told as now.
std::optional<OtherLag> OtherLagOf(const EncoderRun& encoder, const Eigen::VectorXd& shown_rad, bool is_delay);

}  // namespace twinbench::diagnose::encoder
