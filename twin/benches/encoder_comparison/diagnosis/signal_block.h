#pragma once

#include <string>
#include <vector>

#include "twin/benches/encoder_comparison/diagnosis/lag_guess.h"
#include "twin/benches/encoder_comparison/diagnosis/large_causes.h"
#include "twin/benches/encoder_comparison/diagnosis/signal_guess.h"

namespace twinbench::diagnose::encoder {

/// A guess in the words of the catalogue, for the twin to be asked: clipping first, which says where the signals
/// begin; then the faults that it may have beside, and a late reading. What is the same to first order ties with
/// each.
///
/// @param excluded  Effects taken out of the catalogue.
std::vector<LargeCause> SignalBlock(const SignalGuess& guess, const EncoderRun& encoder,
                                    const std::vector<std::string>& excluded);

/// A latency in the words of the catalogue; what is zero of it does not move.
std::vector<ParameterEstimate> LagNumbers(const LagGuess& guess);

/// A delay or a lag and the gain beside it, of a device whose motion the speed does not tell.
std::vector<LargeCause> LagBlock(const LagGuess& guess, const EncoderRun& encoder);

}  // namespace twinbench::diagnose::encoder
