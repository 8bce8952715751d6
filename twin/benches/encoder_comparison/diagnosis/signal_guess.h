#pragma once

#include <optional>

#include "twin/benches/encoder_comparison/diagnosis/signals.h"

namespace twinbench::diagnose::encoder {

/// Signals that are cut off and may have every other fault besides.
struct SignalGuess {
  SignalFaults faults;
  double zero_rad = 0.0;  // device angle where the sine rises, beyond device.signal_zero
  double delay_s = 0.0;   // of the reading; 0 at rest
};

/// What is wrong with the signals of a device that clips them, all faults at once: beside deep clipping no fault
/// has the signature that it has alone. Signals cut off alike are the same after a quarter period with the faults
/// turned on, so that the zero is told within an eighth of a period.
///
/// @param error_rad  Measured - reference, one entry a reading of `context`.
/// @return nothing if free waves of orders 1 to 4 of the period, which is all that whole signals have to first
/// order,
///         explain nearly as much, or if the run does not show the period.
std::optional<SignalGuess> GuessSignals(const SignalContext& context, const Eigen::VectorXd& error_rad);

}  // namespace twinbench::diagnose::encoder
