#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "twin/core/devices.h"
#include "twin/core/scenario.h"
#include "twin/core/stream.h"

/// One block of the multiplexed A/D converter: what the amplifiers offer in, what a driver would deliver out.
///
/// The converter takes the channels in turn at AdcSettings::rate_Hz. Conversion i (channel i mod 4, scan i / 4)
/// happens at t_i = i / rate after the start of the block, so neighbouring channels are skewed by 1 / rate:
///
///     v_i = level + slope t_i + hum sin(2 pi f t_i + phase) + extra(t_i) + noise z_i
///     y_i = v_i + crosstalk v_(i-1)              charge that the multiplexer keeps from the channel before
///     x_i = y_i + step  if y_i >= threshold      code-dependent error of the converter
///     code_i = x_i / LSB to the nearest integer, ties to even (mid-tread), held within the two end codes
///
/// Where the widths of codes are stated, the code is that between whose edges x_i / LSB lies.
namespace twinbench::sim {

class CodeWidths;

/// What reaches one channel of the multiplexer during a block.
struct ChannelInput {
  double level_V = kNaN;  // at t = 0
  double slope_V_s = 0.0;
  double noise_V = 0.0;                       // white, standard deviation of one sample
  std::function<double(double t_s)> extra_V;  // empty: none. Called for t from -1 / rate (crosstalk) to the end
  double crosstalk = 0.0;                     // share of the voltage converted just before
  double step_V = 0.0;                        // added by the converter ...
  double step_threshold_V = 0.0;              // ... to voltages at or above this one; may be infinite
};

/// Mains pick-up: the same sine on every channel, seen by each at its own instants.
struct Hum {
  double amplitude_V = 0.0;
  double frequency_Hz = 50.0;
  double phase_rad = 0.0;  // at t = 0
};

struct AdInput {
  std::array<ChannelInput, kChannels> channel;
  Hum hum;
  const CodeWidths* widths = nullptr;  // null: all codes are equally wide
};

struct AdRequest {
  int n_samples = 0;         // scans, positive
  bool every_sample = true;  // false: draw mean and deviation directly where that has the same distribution
  bool keep_raw = false;     // needs every sample
  bool noise_free = false;   // no random contribution, no quantisation; raw stays empty
};

struct AdBlock {
  ReadingStatus status = ReadingStatus::kOk;  // or kSaturated, kOverrun
  int n_samples = 0;                          // scans delivered; after an overrun fewer than were asked for
  /// Code times LSB. NaN: all after an overrun, mean and deviation of a saturated channel, the deviation of one
  /// sample, the extremes of a block that was drawn directly.
  std::array<ChannelBlock, kChannels> channel{};
  std::array<bool, kChannels> saturated{};  // some sample came out as one of the end codes
  bool drew_every_sample = false;
  std::vector<std::int16_t> raw;  // scans x channels, two's complement codes

  Acquisition ToAcquisition(Time start) const;
};

/// Volts of one code step: +-range over 2^bits codes.
double LsbOf(const AdcSettings& adc);

/// Converts one block.
///
/// @param noise  Every sample: n_samples + 1 blocks of the stream from its next whole one; scan s has block s + 1,
///               the first is for the crosstalk into scan 0. Directly: a random number of words. Seek before each
///               reading, so that readings do not depend on each other.
/// @throws std::logic_error for n_samples < 1, bits outside 2..16, a range or rate that is not positive, an input
///         that is not finite (a step's threshold may be infinite), a negative noise.
///
/// Same input and stream give the same bits on every processor: the normals do, and all sums over random samples
/// are sums of integers.
///
/// Direct drawing is used if no raw codes are wanted, every noise_V is at least LSB / 2 and 4 LSB over the root of
/// n_samples, no extra_V and no widths are set and neither an end code nor the step threshold lies within 8
/// standard deviations of the signal; otherwise every sample is drawn. What it leaves out:
/// - means of codes lie on a lattice of LSB / n_samples, direct ones do not;
/// - quantisation is taken as independent noise of variance LSB^2 / 12. At noise_V = LSB / 2 that is wrong by up to
///   0.003 LSB in the mean and 2.5 % in the variance, at noise_V = LSB by less than 2e-8 in both;
/// - crosstalk correlates the channels' means, but not their deviations.
AdBlock TakeBlock(const AdcSettings& adc, const AdInput& input, const AdRequest& request, Stream& noise);

}  // namespace twinbench::sim
