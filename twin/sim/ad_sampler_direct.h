#pragma once

#include <array>

#include "twin/sim/ad_sampler.h"

/// Closed forms of one block of A/D samples. Private to ad_sampler.cc and its tests.
namespace twinbench::sim {

/// Mean and sum of squared deviations from it of the noise-free samples of one channel.
struct SignalMoments {
  double mean_V = kNaN;
  double squares_V2 = kNaN;
};

/// Moments of level, slope, hum and their crosstalk over `n_samples` scans; extra_V and step are left out.
///
/// The hum enters through the Dirichlet kernel D(x) = sin(n x / 2) / sin(x / 2) = sum of cos(j x) over the n
/// indices j that are centred on the block, its first derivative (correlation with the slope) and D(2 x) (its own
/// square).
std::array<SignalMoments, kChannels> MomentsOf(const AdcSettings& adc, const AdInput& input, int n_samples);

/// @return whether mean and deviation may be drawn instead of the samples: see TakeBlock.
bool CanDrawDirectly(const AdcSettings& adc, const AdInput& input, int n_samples);

/// Draws mean and standard deviation of every channel. min and max stay NaN.
std::array<ChannelBlock, kChannels> DrawDirectly(const AdcSettings& adc, const AdInput& input, int n_samples,
                                                 Stream& noise);

}  // namespace twinbench::sim
