#pragma once

#include "twin/benches/rotary_4dof/settings.h"
#include "twin/benches/rotary_4dof/twin/effect.h"
#include "twin/benches/rotary_4dof/twin/light.h"
#include "twin/core/sampled_curve.h"
#include "twin/core/scenario.h"
#include "twin/core/stream.h"
#include "twin/sim/ad_sampler.h"
#include "twin/sim/block_course.h"
#include "twin/sim/code_widths.h"
#include "twin/sim/flicker_noise.h"
#include "twin/sim/low_pass.h"

namespace twinbench::sim {

/// Noise of the light in one sample, standard deviations at the amplifiers' outputs in channel order.
struct LightNoise {
  std::array<double, kChannels> own_V{};     // shot noise and the detectors' thermal noise
  std::array<double, kChannels> common_V{};  // what one and the same change of the laser's power does; signed
};

/// From spots to A/D blocks: amplifiers with gain, offset, noise and hum, a low pass, then the
/// multiplexed converter.
class Electronics {
 public:
  Electronics(const Scenario& actual, const SamplingState& sampling);

  /// Amplifier outputs for spot coordinates [m] in channel order.
  std::array<double, kChannels> Amplify(const std::array<double, kChannels>& spots_m) const;

  /// Period of the fastest thing that the amplifiers add beside noise and hum; infinite if there is none.
  double Shortest_s() const;
  /// The amplifiers' 1 / f noise.
  void AddFlicker(Time now, std::array<double, kChannels>& signal_V) const;

  /// Of the light itself (psd_noise.h), in the band of the read-out, or of the low pass where that is narrower.
  LightNoise LightNoiseOf(const Spots& spots) const;
  /// By which the low pass is late: what changes slowly is shown as it was this long ago.
  double Lag_s() const { return low_pass_.Lag_s(); }
  /// Behind which the low pass knows nothing of what was before; 0 without one.
  double Memory_s() const { return low_pass_.Memory_s(); }

  /// Converts one block. What changes in it by less than a thousandth of a code step counts as steady, what is that
  /// near to a straight line as one: then samples need not be asked one by one. `reading` enters the noise stream,
  /// so that a reading's noise does not depend on how many samples the readings before it took.
  /// @param light_noise  Comes to the amplifiers' own. Conversions follow each other so late that without a low
  ///                     pass each sees noise of its own; behind one it is correlated in time, and the laser's
  ///                     moves all channels together.
  /// @param before       What the signals were until the block began, for the low pass (low_pass.h).
  Acquisition Convert(BlockCourse course, const std::optional<BlockCourse>& before, const LightNoise& light_noise,
                      Time start, int reading, int n_samples, bool keep_raw);

  /// The mean that such a block would have if it were taken again and again: hum and crosstalk as they fall into
  /// it, a step of the converter blurred by the samples' noise, no quantisation. NaN at the ends of the range.
  /// @param noise_V  Standard deviation of one sample.
  std::array<double, kChannels> Expect(std::array<double, kChannels> signal_V, Time start, int n_samples,
                                       double noise_V) const;

 private:
  BlockCourse LowPassed(const BlockCourse& course, const std::optional<BlockCourse>& before,
                        const LightNoise& light_noise, int reading, int n_samples) const;
  void AddPoledNoise(const LightNoise& light_noise, double step_s, int reading, BlockCourse& course) const;
  double AsConverted_V(double voltage_V) const;
  double JitterNoise_V(const BlockCourse& course, std::size_t channel) const;
  int Arriving(int n_samples, int reading) const;
  AdInput InScanOrder(const std::array<double, kChannels>& level_V, Time start) const;
  void Follow(const BlockCourse& course, AdInput& input) const;
  Acquisition InChannelOrder(const Acquisition& scanned) const;

  std::array<PsdSettings, 2> psd_;
  double rin_dB_Hz_;
  AdcSettings adc_;
  AmplifierSettings amplifier_;
  std::array<double, kChannels> sensitivity_V_m_;
  SamplingState sampling_;
  std::array<std::size_t, kChannels> scan_;  // channel of each place in the scan
  bool noise_free_;
  std::uint64_t seed_;
  Stream noise_;
  std::vector<FlickerNoise> flicker_;  // one a channel
  LowPass low_pass_;
  CodeWidths widths_;
  SampledCurve non_linearity_V_;  // what the converter adds, over the voltage
};

}  // namespace twinbench::sim
